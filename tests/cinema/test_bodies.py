"""What people hide of themselves and of others."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from company import FILMING, FRAMES, takes_of, two
from filmset import shot

from vdsl.cinema.bodies import behind_own_back, pillars
from vdsl.cinema.measures import measure
from vdsl.cinema.subject import Subject
from vdsl.cinema.track import camera_axes, project
from vdsl.propose.subjects import performed, subject_of

AT = np.arange(FRAMES)


def anna() -> Subject:
    told = two((0.0, 0.9))
    return performed("anna", told.performances["anna"], FILMING.skeletons["anna"])


def bent(one: Subject) -> Subject:
    """Doubled over along the way they face, the back level."""
    marks = dict(one.landmarks)
    for name, ahead, high in (
        *(("pocket", 0.3, 0.95), ("collar", 0.45, 0.92), ("chin", 0.6, 0.85), ("eyes", 0.66, 0.8)),
        *(("crown", 0.75, 0.75), ("top", 0.76, 0.75)),
    ):
        marks[name] = np.tile((ahead, 0.0, high), (FRAMES, 1))
    return replace(one, landmarks=marks)


def hidden(one: Subject, *eye: float) -> bool:
    found = behind_own_back(one, AT, np.tile(eye, (1, FRAMES, 1)))
    assert found.shape == (1, FRAMES)
    assert found.all() == found.any()
    return bool(found.all())


@pytest.mark.parametrize("eye", [(-3.0, 0.0, 1.5), (3.0, 0.0, 1.5), (0.0, 3.0, 1.5), (-3.0, 0.0, 3.0)])
def test_who_stands_upright_hides_no_head_of_theirs(eye: tuple[float, float, float]) -> None:
    assert not hidden(anna(), *eye)


def test_who_is_doubled_over_hides_their_own_head_from_behind_alone() -> None:
    one = bent(anna())
    assert hidden(one, -3.0, 0.0, 1.4)
    assert not hidden(one, 3.0, 0.0, 1.4)
    assert not hidden(one, 0.0, 3.0, 1.4)
    assert not hidden(one, -1.0, 0.0, 4.0), "one looks down on it"


def test_a_body_is_a_trunk_two_arms_and_a_head() -> None:
    found = pillars(anna())
    assert len(found) == 4
    for foot, crown, radius in found:
        assert foot.shape == crown.shape == (FRAMES, 3)
        assert (crown[:, 2] > foot[:, 2] + 1.2).all()
        assert 0.05 < radius < 0.2
    left, right = found[1][1], found[2][1]
    assert left[0, 1] > 0.1 > -0.1 > right[0, 1]


def test_a_head_that_only_touches_the_border_is_not_taken_for_seen() -> None:
    told = two((0.0, 9.0))  # he is far out of the picture
    subject = subject_of(shot(scale="full"), told, FILMING)
    eye, eyes = (6.0, 0.0, 1.4), subject.landmarks["eyes"][:1]
    found: dict[bool, list[float]] = {True: [], False: []}
    for aside in np.linspace(2.0, 4.0, 200):
        takes = takes_of("full", "person", eye, (0.0, float(aside), 1.4))
        track = takes.track
        axes = camera_axes(track.rotation[0, :1])
        xy, _ = project(eyes[:, None], np.array([eye]), axes, track.focal[0, :1], track.sensor)
        x = float(xy[0, 0, 0])
        near = min(x, 1.0 - x)
        if 0.0 < near < 0.04 and not 0.008 < near < 0.022:
            heads = measure(takes, subject, FILMING.world, 24.0).values["heads"]
            found[near > 0.02].append(2 * float(heads[0]))  # hers, and not his
    assert len(found[True]) > 2
    assert len(found[False]) > 2
    assert set(found[True]) == {1.0}
    assert set(found[False]) == {0.0}
