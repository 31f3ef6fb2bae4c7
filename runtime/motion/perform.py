"""Turns tasks into a performed scene."""

from __future__ import annotations

from .types import Actor, PropState, SceneMotion, Task


def perform(
    actors: dict[str, Actor], tasks: dict[str, Task], props: dict[int, PropState], fps: float, seed: int
) -> SceneMotion:
    """Everybody over one shot: those with a task act, the others idle."""
    raise NotImplementedError
