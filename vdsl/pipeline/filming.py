"""Draws proposals: eight small frames of each for the judge, full frames of the takes that are kept."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ranker.guides import Guides
from runtime.raster.renderer import Renderer
from runtime.raster.types import STYLES, Camera, Frames, Views

from ..cinema.takes import SAMPLES
from ..cinema.track import CameraTrack
from ..propose.types import CameraProposal, StoryProposal
from ..stage.assemble import StagedScene, palettes
from .guides import About, guides_of, paces_of, pointed, roles_of, room_of
from .shutter import between, camera_between, exposed_frames, moments_needed

#: The discriminator looks at this many frames of this size (the paper's section 3.3): the measured ones.
SEGMENTS = SAMPLES
JUDGE_SIZE = (224, 224)
#: Full frames drawn in one launch: enough to keep every core busy, few enough to stay small; on a GPU, which
#: twelve do not fill, twice as many.
_FRAMES_A_LAUNCH, _ON_A_GPU = 12, 24
#: Every so many frames of a take are asked how fine the bodies in them have to be.
_LOOKED_AT = 4


def segment_frames(frames: int, segments: int = SEGMENTS) -> NDArray[np.int64]:
    """Frames evenly spaced over a shot, its first and its last among them.

    TSN takes the middles of equal parts, and never sees how a shot begins and ends, where it shows whether a
    pan or a push arrives.
    """
    return np.asarray(np.round(np.arange(segments) * (frames - 1) / (segments - 1)).astype(np.int64))


def not_drawn(staged: StagedScene, camera: CameraProposal) -> NDArray[np.bool_]:
    """What a take leaves out, bool [W + people]: walls, then whoever it looks through the eyes of."""
    people = np.array([name == camera.unseen for name in staged.bodies], bool)
    return np.concatenate([camera.hidden_walls, people])


class Seen(NamedTuple):
    """What the judge sees of P proposals: frames uint8 [P, k, H, W, 3], and their guides if asked for; and
    ids of objects, int32, and metres along the axis, float32 [P, k, H, W], if asked for."""

    frames: NDArray[np.uint8]
    guides: Guides | None
    ids: NDArray[np.int32] | None = None
    depth: NDArray[np.float32] | None = None

    def only(self, rows: list[int]) -> Seen:
        """Ids and depths of some of the proposals."""
        ids, depth = self.ids, self.depth
        return Seen(
            self.frames[:0], None, None if ids is None else ids[rows], None if depth is None else depth[rows]
        )


class Camerawork:
    """Draws any proposal of the scene it was last shown. One renderer for each style that is asked for."""

    def __init__(self, device: str) -> None:
        self._device = device
        self._renderers: dict[str, Renderer] = {}
        self._loaded: dict[str, StagedScene] = {}

    def judge_frames(
        self,
        staged: StagedScene,
        style: str,
        stories: tuple[StoryProposal, ...],
        cameras: tuple[CameraProposal, ...],
        size: tuple[int, int] = JUDGE_SIZE,
        which: Sequence[int] = range(SEGMENTS),
        about: Sequence[About] | None = None,
        pictures: bool = True,
        depths: bool = False,
    ) -> Seen:
        """Frames for ranking of P proposals; shared moments are skinned once.

        which: of the eight, those that are wanted; about: what each camera is about, for guides;
            pictures: whether to shade, or frames of 0 x 0 will do; depths: with guides, whether ids and
            depths are wanted too
        """
        views, moments = self._segments(staged, stories, cameras, which)
        renderer = self._renderer(staged, style)
        if about is None:
            drawn = renderer.render(moments, views, size, pictures=pictures)
            return Seen(drawn.color.reshape(len(cameras), len(which), *drawn.color.shape[1:]), None)
        whole = [subject.places[c.story] for c, subject in zip(cameras, about, strict=True)]
        judged = [segment_frames(len(p.points)) for p in whole]
        places = [p.at(frames[list(which)]) for p, frames in zip(whole, judged, strict=True)]
        paces, works = (
            np.concatenate([told[list(which)] for told in of_shots])
            for of_shots in (
                [paces_of(c.track, f, p.seconds) for c, p, f in zip(cameras, whole, judged, strict=True)],
                [p.works_about(frames) for p, frames in zip(whole, judged, strict=True)],
            )
        )
        roles = np.repeat(roles_of(staged, about), len(which), axis=0)
        at = pointed(views.camera, places, size)
        drawn = renderer.render(
            *(moments, views, size),
            ids=depths,
            depth=depths,
            roles=roles,
            pictures=pictures,
            pixels=at.pixels,
        )
        assert drawn.guides is not None
        assert drawn.probed is not None
        frames = drawn.color.reshape(len(cameras), len(which), *drawn.color.shape[1:])
        opened = [bool(c.hidden_walls.any()) for c in cameras]
        hidden = np.stack([c.hidden_walls for c in cameras])
        room = room_of(staged.world.solids, views.camera.position, hidden, places)
        gone = np.column_stack([paces, room, works])
        told = guides_of(drawn.guides, drawn.probed, at, views.camera, places, opened, gone, which, SEGMENTS)
        if drawn.ids is None or drawn.depth is None:
            return Seen(frames, told)
        by_shot = (len(cameras), len(which), *drawn.ids.shape[1:])
        return Seen(frames, told, drawn.ids.reshape(by_shot), drawn.depth.reshape(by_shot))

    def judge_ids(
        self,
        staged: StagedScene,
        style: str,
        stories: tuple[StoryProposal, ...],
        cameras: tuple[CameraProposal, ...],
        size: tuple[int, int],
    ) -> NDArray[np.int32]:
        """Object ids in the same frames: int32 [P, 8, H, W]."""
        views, moments = self._segments(staged, stories, cameras, range(SEGMENTS))
        ids = self._renderer(staged, style).render(moments, views, size, ids=True, pictures=False).ids
        assert ids is not None
        return ids.reshape(len(cameras), SEGMENTS, *ids.shape[1:])

    def _segments(
        self,
        staged: StagedScene,
        stories: tuple[StoryProposal, ...],
        cameras: tuple[CameraProposal, ...],
        which: Sequence[int],
    ) -> tuple[Views, NDArray[np.float32]]:
        """Views and palettes of the middle frames of some of the segments of P proposals, one after the
        other."""
        used = {c.story for c in cameras}
        at = {s.index: segment_frames(s.frames)[list(which)] for s in stories if s.index in used}
        first = {story: k * len(which) for k, story in enumerate(at)}
        by_index = {s.index: s for s in stories}
        moments = np.concatenate([story_palettes(staged, by_index[i], frames) for i, frames in at.items()])
        moment = np.concatenate([first[c.story] + np.arange(len(which)) for c in cameras])
        tracks = [(c.track, at[c.story]) for c in cameras]
        hidden = np.repeat(np.stack([not_drawn(staged, c) for c in cameras]), len(which), axis=0)
        views = Views(_camera(tracks), moment.astype(np.int32), hidden)
        return views, moments

    def take_frames(
        self,
        staged: StagedScene,
        style: str,
        story: StoryProposal,
        camera: CameraProposal,
        size: tuple[int, int],
        shutter: float = 0.0,
    ) -> Iterator[NDArray[np.uint8]]:
        """Every frame of a take in order, uint8 [H, W, 3]; a few are drawn at a time.

        shutter: degrees that it is open, for motion blur; 0 for none
        """
        renderer = self._renderer(staged, style)
        detail = _take_detail(renderer, staged, story, camera, size)

        at_once = _FRAMES_A_LAUNCH if renderer.backend.on_host else _ON_A_GPU

        def draw(begin: int) -> NDArray[np.uint8]:
            frames = np.arange(begin, min(begin + at_once, story.frames))
            if shutter > 0:
                return _blurred(renderer, staged, story, camera, size, frames, shutter, detail)
            hidden = np.repeat(not_drawn(staged, camera)[None], len(frames), axis=0)
            taken = _camera([(camera.track, frames)], optics=True)
            levels = np.repeat(detail, len(frames), axis=0)
            views = Views(taken, np.arange(len(frames), dtype=np.int32), hidden, levels)
            return renderer.render(story_palettes(staged, story, frames), views, size).color

        for begin in range(0, story.frames, at_once):
            yield from draw(begin)

    def frames_at(
        self,
        staged: StagedScene,
        style: str,
        story: StoryProposal,
        camera: CameraProposal,
        size: tuple[int, int],
        at: NDArray[np.integer],
    ) -> NDArray[np.uint8]:
        """Some frames of a take, uint8 [N, H, W, 3]; at: [N] indices."""
        renderer = self._renderer(staged, style)
        hidden = np.repeat(not_drawn(staged, camera)[None], len(at), axis=0)
        levels = np.repeat(_take_detail(renderer, staged, story, camera, size), len(at), axis=0)
        moment = np.arange(len(at), dtype=np.int32)
        views = Views(_camera([(camera.track, at)], optics=True), moment, hidden, levels)
        return renderer.render(story_palettes(staged, story, at), views, size).color

    def stills(
        self,
        staged: StagedScene,
        style: str,
        moments: NDArray[np.float32],
        views: Views,
        size: tuple[int, int],
        ids: bool = False,
    ) -> Frames:
        """Single pictures from anywhere; moments: palettes float32 [M, P, 3, 4]; ids: with the object ids."""
        return self._renderer(staged, style).render(moments, views, size, ids=ids)

    def _renderer(self, staged: StagedScene, style: str) -> Renderer:
        if style not in self._renderers:
            self._renderers[style] = Renderer(self._device, STYLES[style])
        if self._loaded.get(style) is not staged:
            self._renderers[style].load(staged.render)
            self._loaded[style] = staged
        return self._renderers[style]


def _take_detail(
    renderer: Renderer,
    staged: StagedScene,
    story: StoryProposal,
    camera: CameraProposal,
    size: tuple[int, int],
) -> NDArray[np.int32]:
    """The levels of detail that are fine enough for a whole take, int32 [1, B]: none changes on the way."""
    asked = np.unique(np.append(np.arange(0, story.frames, _LOOKED_AT), story.frames - 1))
    finest = []
    for begin in range(0, len(asked), _FRAMES_A_LAUNCH):  # a few poses at a time
        at = asked[begin : begin + _FRAMES_A_LAUNCH]
        hidden = np.repeat(not_drawn(staged, camera)[None], len(at), axis=0)
        views = Views(_camera([(camera.track, at)]), np.arange(len(at), dtype=np.int32), hidden)
        finest.append(renderer.levels(story_palettes(staged, story, at), views, size).min(axis=0))
    return np.stack(finest).min(axis=0, keepdims=True)


def _blurred(
    renderer: Renderer,
    staged: StagedScene,
    story: StoryProposal,
    camera: CameraProposal,
    size: tuple[int, int],
    frames: NDArray[np.integer],
    shutter: float,
    detail: NDArray[np.int32],
) -> NDArray[np.uint8]:
    """Some frames of a take as a shutter sees them, uint8 [F, H, W, 3]."""
    first, last = max(int(frames[0]) - 1, 0), min(int(frames[-1]) + 1, story.frames - 1)
    around = np.arange(first, last + 1)
    poses = story_palettes(staged, story, around)
    taken = _camera([(camera.track, around)], optics=True)
    joints = [p.world_from_joint[around, :, :3, 3] for p in story.performances.values()]
    props = [track[around, None, :3, 3] for track in story.props.values()]
    moving = np.concatenate([np.zeros((len(around), 0, 3)), *joints, *props], axis=1)
    hidden = not_drawn(staged, camera)[None]

    def needed(ends: NDArray[np.float64]) -> int:
        return moments_needed(camera_between(taken, ends - first), between(moving, ends - first), size)

    def draw(at: NDArray[np.float64]) -> NDArray[np.uint8]:
        seen, many = camera_between(taken, at - first), len(at)
        moment = np.arange(many, dtype=np.int32)
        views = Views(seen, moment, np.repeat(hidden, many, axis=0), np.repeat(detail, many, axis=0))
        return renderer.render(between(poses, at - first), views, size).color

    return exposed_frames(frames, story.frames, shutter, needed, draw)


def first_frame(track: CameraTrack) -> Camera:
    """A track's first frame as a camera."""
    return _camera([(track, np.array([0]))])


def some_frames(track: CameraTrack, frames: NDArray[np.integer], optics: bool = False) -> Camera:
    """Some of a track's frames as a batch of cameras. optics: with its focus and aperture"""
    return _camera([(track, frames)], optics)


def story_palettes(
    staged: StagedScene, story: StoryProposal, frames: NDArray[np.integer]
) -> NDArray[np.float32]:
    """Palettes float32 [F, P, 3, 4] of some frames of a performance."""
    joints = {name: p.world_from_joint for name, p in story.performances.items()}
    return palettes(staged, joints, story.props, frames)


def _camera(tracks: Sequence[tuple[CameraTrack, NDArray[np.integer]]], optics: bool = False) -> Camera:
    """The chosen frames of several tracks, one after the other, as a batch of cameras.

    optics: with the focus and aperture of the one track there is; what is judged stays sharp
    """
    first, frames = tracks[0]
    blurs = optics and first.focus is not None and float(first.aperture) > 0
    return Camera(
        position=np.concatenate([t.position[f] for t, f in tracks]).astype(np.float32),
        axes=np.concatenate([t.axes[f] for t, f in tracks]).astype(np.float32),
        focal=np.concatenate([t.focal[f] for t, f in tracks]).astype(np.float32),
        sensor=first.sensor,
        focus=first.focus[frames].astype(np.float32) if blurs and first.focus is not None else None,
        aperture=float(first.aperture) if blurs else 0.0,
    )
