"""Manners: how anything may be done, whatever it is. Pure Python, so that the checker may read the words.

A manner changes the pace, the size of movements and how the body is carried, on top of a gait and of the
keys of an action. The table is data alone; :mod:`.acting`, :mod:`.plan` and :mod:`.gait` obey it.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Manner:
    """One way of doing things. Angles are radians, lengths metres (for a person of 1.7 m).

    tempo: factor on the speed of what is done; amplitude: factor on poses away from rest and on beats
    stride: factor on the step length; cadence: factor on the time between steps
    lean: of the trunk, forward; nod: of the head, down; up, forward: of both shoulders
    arms: factor on their swing while walking; bend: of hanging elbows
    lift: more height of swung feet; crouch: lower; width: factor on the distance of the feet; bounce: up and
        down at every step; toes: 0..1, on tiptoe
    sway: trunk from side to side, slow; wobble: how far the way swerves to the sides, metres
    loose: how far the head lolls; restless: factor on idle movement; fists: 0..1, how far empty hands close
    feeling: what shows on the face meanwhile, if the line says no other
    """

    tempo: float = 1.0
    amplitude: float = 1.0
    stride: float = 1.0
    cadence: float = 1.0
    lean: float = 0.0
    nod: float = 0.0
    up: float = 0.0
    forward: float = 0.0
    arms: float = 1.0
    bend: float = 0.0
    lift: float = 0.0
    crouch: float = 0.0
    width: float = 1.0
    bounce: float = 0.0
    toes: float = 0.0
    sway: float = 0.0
    wobble: float = 0.0
    loose: float = 0.0
    restless: float = 1.0
    fists: float = 0.0
    feeling: str = ""


PLAIN = Manner()
MANNERS: dict[str, Manner] = {
    "briskly": Manner(tempo=1.3, amplitude=1.05, stride=1.1, cadence=0.84, lean=0.05, arms=1.35, bend=0.15),
    "quickly": Manner(tempo=1.5, amplitude=1.0, stride=1.12, cadence=0.74, lean=0.09, arms=1.3, bend=0.35),
    "slowly": Manner(tempo=0.65, amplitude=0.95, stride=0.85, cadence=1.3, arms=0.75),
    "calmly": Manner(tempo=0.82, amplitude=0.85, stride=0.95, cadence=1.12, arms=0.85, restless=0.5),
    "sadly": Manner(
        tempo=0.7, amplitude=0.76, stride=0.74, cadence=1.3, lean=0.16, nod=0.26, up=-0.1, forward=0.22,
        arms=0.3, restless=0.6, feeling="sad",
    ),
    "drunk": Manner(
        tempo=0.8, amplitude=1.2, stride=0.82, cadence=1.15, lean=0.05, nod=0.1, arms=0.8, width=1.7,
        crouch=0.02, sway=0.17, wobble=0.16, loose=0.22, restless=2.5,
    ),
    "proudly": Manner(
        tempo=0.92, amplitude=1.1, stride=1.08, cadence=1.04, lean=-0.16, nod=-0.2, up=0.0, forward=-0.28,
        arms=1.25, bounce=0.01,
    ),
    "nervously": Manner(
        tempo=1.15, amplitude=0.7, stride=0.78, cadence=0.86, lean=0.1, nod=0.1, up=0.22, forward=0.2,
        arms=0.4, bend=1.0, restless=2.4, loose=0.1, fists=0.4, feeling="afraid",
    ),
    "stealthily": Manner(
        tempo=0.75, amplitude=0.8, stride=0.85, cadence=1.4, lean=0.3, nod=-0.16, up=0.05, forward=0.12,
        arms=0.4, bend=0.7, lift=0.09, crouch=0.1, toes=0.35, restless=0.5,
    ),
    "angrily": Manner(
        tempo=1.25, amplitude=1.2, stride=1.1, cadence=0.84, lean=0.2, nod=0.12, up=0.12, forward=0.1,
        arms=1.35, bend=0.6, fists=1.0, feeling="angry",
    ),
    "happily": Manner(
        tempo=1.1, amplitude=1.15, stride=1.03, cadence=0.92, lean=-0.07, nod=-0.12, up=0.02, forward=-0.12,
        arms=1.75, bounce=0.035, lift=0.03, sway=0.06, loose=0.05, feeling="happy",
    ),
    "tiredly": Manner(
        tempo=0.72, amplitude=0.75, stride=0.74, cadence=1.3, lean=0.2, nod=0.24, up=-0.1, forward=0.16,
        arms=0.5, crouch=0.03, lift=-0.015, sway=0.04, loose=0.06, width=1.2,
    ),
}  # fmt: skip


def manner_of(word: str) -> Manner:
    """The manner of a word; nothing particular for ""."""
    return MANNERS.get(word, PLAIN)
