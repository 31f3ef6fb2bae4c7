"""Clips out of films, and what a writer's choices teach."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from tastes import some_taste
from typer.testing import CliRunner

from ranker.data import Dataset, ShardWriter
from ranker.errors import RankerError
from ranker.taste import load_taste, save_taste
from runtime.video import VideoError, write_video
from vdsl.cinema.measures import MEASURES
from vdsl.cinema.traits import TRAITS
from vdsl.cli import app
from vdsl.pipeline.dataset import made
from vdsl.pipeline.judging import prior
from vdsl.pipeline.keys import judge_digest
from vdsl.pipeline.labels import WORDS
from vdsl.pipeline.lock import lock_path
from vdsl.pipeline.options import Options
from vdsl.pipeline.picked import picked
from vdsl.pipeline.realclips import add_films, add_picks, clip_of, words_of
from vdsl.pipeline.tasting import Learnt, home_of, taste_of


def film(path: Path, frames: int = 24, blue: int = 40) -> None:
    """A film that grows lighter."""
    path.parent.mkdir(parents=True, exist_ok=True)
    pictures = (np.full((48, 64, 3), (8 * t, 8 * t, blue), np.uint8) for t in range(frames))
    write_video(path, pictures, (24, 1))


def test_a_clip_is_eight_frames_from_the_first_to_the_last(tmp_path: Path) -> None:
    film(tmp_path / "a.mp4")
    clip = clip_of(tmp_path / "a.mp4", 32)
    assert clip.shape == (8, 32, 32, 3)
    assert np.allclose(clip[:, 16, 16, 0], 8 * np.round(np.arange(8) * 23 / 7), atol=6)


def test_names_say_classes() -> None:
    assert words_of("pan-left_medium_eye-level_012") == ("pan", "medium", "eye-level")
    assert words_of("CU crane-up") == ("crane", "close-up", None)
    assert words_of("IMG_2041") == (None, None, None)


def test_real_clips_are_added_once_and_bad_ones_told(tmp_path: Path) -> None:
    films, data = tmp_path / "films", tmp_path / "data"
    film(films / "one" / "static_medium_1.mp4")
    film(films / "two" / "b.mov")
    film(films / "two" / "short.mp4", frames=5)
    (films / "broken.mp4").write_bytes(b"no film")
    heard: list[str] = []
    assert add_films(data, films, made(0), heard.append, 32) == 2
    assert add_films(data, films, made(0), heard.append, 32) == 0
    assert any("short.mp4" in text for text in heard)
    assert any("broken.mp4" in text for text in heard)
    labels = Dataset(data).labels
    assert [(x.professional, x.movement, x.about["file"]) for x in labels] == [
        (True, "static", "one/static_medium_1.mp4"),
        (True, None, "two/b.mov"),
    ]
    assert len({x.group for x in labels}) == 2
    with pytest.raises(VideoError, match="8 frames"):
        clip_of(films / "two" / "short.mp4")
    with pytest.raises(RankerError, match="no clips"):
        add_films(data, tmp_path / "data", made(0))


def test_real_clips_go_into_a_set_of_any_kind_and_another_size_is_told(tmp_path: Path) -> None:
    """They are the same to all: of a set with few pictures, or another seed, they were refused."""
    film(tmp_path / "films" / "a.mp4")
    data = tmp_path / "data"
    kind = made(7, pictures=0.5, every=True)
    with ShardWriter(data, WORDS, (32, 32), 8, made=kind):
        pass
    assert add_films(data, tmp_path / "films", made(0), size=32) == 1
    assert Dataset(data).made == kind
    with pytest.raises(RankerError, match=r"size \[32, 32\] there, \[64, 64\] here"):
        add_films(data, tmp_path / "films", made(0), size=64)
    with pytest.raises(
        RankerError, match=r"\(seed 7 there, 0 here, pictures 0.5 there, unsaid here, every True"
    ):
        ShardWriter(data, WORDS, (32, 32), 8, made=made(0))
    other = tmp_path / "other"
    assert add_films(other, tmp_path / "films", kind, size=32) == 1
    assert Dataset(other).made == kind  # so that filming goes on with it


FILES = {"video": "mp4", "track": "json"}


def script_with_choice(folder: Path) -> Path:
    """A storyboard with a chosen take, and what matters of its build."""
    script, shot = folder / "tale.vds", "kitchen-anna-wave"
    script.write_text("", "utf-8")
    keys = ("0-aaaaaaaa", "1-bbbbbbbb", "2-cccccccc")
    lock_path(script).write_text(
        f'vds.lock/1\nseed 0\n\ntake {shot} {keys[1]} of 80 line 9c41d2e07a55 "push medium high-angle"\n'
    )
    takes = []
    for rank, key in enumerate(keys, 1):
        film(folder / "build" / "tale" / "shots" / shot / f"take-{rank}.mp4", blue=60 * rank)
        files = {name: f"shots/{shot}/take-{rank}.{end}" for name, end in FILES.items()}
        words = {"movement": "push", "scale": "medium", "angle": "high-angle"}
        measures = {"elevation": 10.0 * rank, "speed": 0.5, "face": None}
        judged = {"score": 0.9 - 0.1 * rank, "logit": 2.0 - rank, "taste": 1.5}
        takes.append({"rank": rank, "key": key, **judged, **words, **files, "measures": measures})
        track = {"camera": {"focal_mm": [35.0, 50.0]}}
        (folder / "build" / "tale" / files["track"]).write_text(json.dumps(track))
    document = {"judge": "ranker", "taste": None, "shots": [{"id": shot, "takes": takes}]}
    (folder / "build" / "tale" / "storyboard.json").write_text(json.dumps(document))
    return script


def test_choices_are_read_with_the_takes_they_were_among(tmp_path: Path) -> None:
    script = script_with_choice(tmp_path)
    (shot,) = picked(script)
    assert (len(shot.takes), shot.chosen) == (3, 1)
    assert add_picks(tmp_path / "data", [script], made(0), 32) == 1
    assert add_picks(tmp_path / "data", [script], made(0), 32) == 0
    data = Dataset(tmp_path / "data")
    (label,) = data.labels
    assert (label.movement, label.scale, label.angle) == ("push/pull", "medium", "high-angle")
    assert abs(int(data.clip(0, [0], 32)[0, 8, 8, 2]) - 120) < 8
    lock_path(script).unlink()
    assert picked(script) == []


def test_choices_are_read_without_films_too(tmp_path: Path) -> None:
    script = script_with_choice(tmp_path)
    for some in (tmp_path / "build").rglob("*.mp4"):
        some.unlink()
    (shot,) = picked(script)
    measured = [dict.fromkeys(MEASURES, 0.0) | {"elevation": 10.0 * k, "speed": 0.5} for k in (1, 2, 3)]
    assert shot.odds == pytest.approx([2.0 - k + prior(m) for k, m in enumerate(measured, 1)])
    traits = dict(zip(TRAITS, shot.traits.T, strict=True))
    assert traits["elevation"] == pytest.approx([1, 2, 3])
    assert (traits["push"].tolist(), traits["pan"].tolist()) == ([1.0] * 3, [0.0] * 3)
    assert traits["focal"] == pytest.approx(np.full(3, np.log(42.5) / TRAITS["focal"].step))
    document = tmp_path / "build" / "tale" / "storyboard.json"
    document.write_text(re.sub(r'"logit": [^,]*,', '"logit": null,', document.read_text()))
    assert picked(script)[0].odds.tolist() == [0.0, 0.0, 0.0]  # of a build by geometry alone


def test_what_was_learnt_is_told(tmp_path: Path) -> None:
    likes = dict.fromkeys(TRAITS, 0.0) | {
        "height": -3.0,
        "face": 2.0,
        "pan": -1.6,
        "speed": 1.55,
        "focal": 1.0,
    }
    assert Learnt(tmp_path, 1, likes).words == ("a low camera", "faces to the camera", "no pan shots")
    assert Learnt(tmp_path, 1, dict.fromkeys(TRAITS, 0.3)).words == ()
    script = script_with_choice(tmp_path)
    result = CliRunner().invoke(app, ["train", "--picks", str(script)])
    assert result.exit_code == 0, result.output
    assert "vds.taste: learnt from 1 choice" in result.stdout
    assert load_taste(tmp_path / "vds.taste", tuple(TRAITS)).choices == 1
    lock_path(script).unlink()
    result = CliRunner().invoke(app, ["train", "--picks", str(script)])
    assert result.exit_code != 0
    assert "choose takes with `vdsc pick` first" in result.stderr


def test_choices_without_a_build_are_told(tmp_path: Path) -> None:
    script = script_with_choice(tmp_path)
    document = tmp_path / "build" / "tale" / "storyboard.json"
    whole = document.read_text()
    drafted = json.loads(whole)
    drafted["shots"][0]["takes"] = drafted["shots"][0]["takes"][1:2]
    document.write_text(json.dumps(drafted))
    with pytest.raises(RankerError, match=r"no other takes beside those chosen; compile .* whole"):
        picked(script)
    for damaged in (
        whole.replace('"taste": 1.5', '"was": 1.5'),
        re.sub(r'"measures": {[^}]*}', '"measures": []', whole),
    ):
        assert damaged != whole
        document.write_text(damaged)
        with pytest.raises(RankerError, match=r"no build of this version; compile .* again"):
            picked(script)
    document.write_text("{}")
    with pytest.raises(RankerError, match="compile"):
        picked(script)
    document.unlink()
    with pytest.raises(RankerError, match="compile"):
        picked(script)


def test_a_taste_belongs_to_its_project_and_counts_in_what_is_kept(tmp_path: Path) -> None:
    script = tmp_path / "a" / "b" / "tale.vds"
    script.parent.mkdir(parents=True)
    (tmp_path / "a" / "vds.toml").write_text("")
    assert taste_of(script) is None
    assert home_of(script) == tmp_path / "a" / "vds.taste"
    assert home_of(tmp_path / "tale.vds") == tmp_path / "vds.taste"
    save_taste(tmp_path / "vds.taste", some_taste())
    assert taste_of(script) is None  # another project's
    save_taste(home_of(script), some_taste())
    assert taste_of(script) == home_of(script)
    assert judge_digest(Options(taste=home_of(script))) != judge_digest(Options())
