"""Values into numbers and words: :func:`evaluate`.

Everything comes out in SI units: metres, radians, seconds; a percentage is a fraction. A bare number
where a unit is needed is an error with the fix; 0 needs none. Never raises: what cannot be evaluated
is reported and comes out as None.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from . import ast
from .definitions.types import ParameterSpec
from .diagnostics import Report, listing, nearest
from .source import Span


@dataclass(frozen=True)
class Quantity:
    """A number with what it measures: length, angle, seconds, number, or any (not known)."""

    value: float
    kind: str


#: What a name may stand for: a number in SI units (of a kind not known), a quantity, or a word.
Bound: TypeAlias = float | int | str | Quantity
Env: TypeAlias = Mapping[str, Bound]

UNIT_KIND = {"m": "length", "cm": "length", "mm": "length", "deg": "angle", "s": "seconds", "%": "number"}
UNIT_SCALE = {"m": 1.0, "cm": 0.01, "mm": 0.001, "deg": math.pi / 180, "s": 1.0, "%": 0.01}
_EXAMPLES = {"length": ("m", "a length"), "angle": ("deg", "an angle"), "seconds": ("s", "a time")}
_DESCRIBE = {"length": "a length", "angle": "an angle", "seconds": "a time", "number": "a bare number",
             "word": "a word", "text": "a text in quotes"}  # fmt: skip


def evaluate(
    value: ast.Value, env: Env, want: str, report: Report, unit: str | None = None
) -> float | str | None:
    """One value as what is wanted, or None where it was reported to be something else.

    want: length (metres), angle (radians), seconds, number, word or text
    unit: the unit of the parentheses around it, for bare numbers
    """
    if want in ("word", "text"):
        return _word(value, env, want, report)
    got = _number(value, env, report)
    if got is None:
        return None
    if got.kind == "number" and unit is not None and unit in UNIT_SCALE:
        got = Quantity(got.value * UNIT_SCALE[unit], UNIT_KIND[unit])
    if got.kind in (want, "any") or (got.value == 0 and got.kind == "number"):
        return got.value
    if got.kind == "number":
        short, what = _EXAMPLES[want]
        text = value.span.text
        fix = f"{text}{short}" if isinstance(value, ast.Number) else None
        report.error(
            "VDS020",
            value.span,
            label=f"{what} needs a unit",
            help=f"write {fix}" if fix else f"multiply it by 1{short}",
            fix=fix,
        )
        return got.value * UNIT_SCALE[short]  # as it was probably meant, so that one mistake is one
    else:
        report.error(
            "VDS021", value.span, label=f"{_DESCRIBE[want]} is wanted here, this is {_DESCRIBE[got.kind]}"
        )
    return None


def evaluate_point(
    value: ast.Value, env: Env, report: Report, want: str = "length"
) -> tuple[float, ...] | None:
    """A group of numbers, ``(1, 2, 0.5)m``, as a tuple (metres unless said otherwise)."""
    if not isinstance(value, ast.Group):
        report.error(
            "VDS021",
            value.span,
            label="a point in parentheses is wanted here",
            help="such as (1, 2)m or (10cm, 0, 1m)",
        )
        return None
    unit = value.unit
    if unit is None and want in _EXAMPLES and _all_bare(value):
        unit, what = _EXAMPLES[want]
        fix = f"{value.span.text}{unit}"
        report.error(
            "VDS020",
            value.span,
            label=f"each of these is {what} and needs a unit",
            help=f"write {fix}",
            fix=fix,
        )
    numbers = [evaluate(item, env, want, report, unit) for item in value.items]
    if any(n is None for n in numbers):
        return None
    return tuple(float(n) for n in numbers if n is not None)


def _all_bare(group: ast.Group) -> bool:
    """Whether a group has nothing but numbers without units, and not only zeros."""
    numbers = [item.value if isinstance(item, ast.Negate) else item for item in group.items]
    bare = all(isinstance(n, ast.Number) and n.unit is None for n in numbers)
    return bare and any(isinstance(n, ast.Number) and n.value != 0 for n in numbers)


def evaluate_arguments(
    arguments: Iterable[ast.Argument], specs: Sequence[ParameterSpec], env: Env, report: Report, callee: str
) -> dict[str, float | str]:
    """The arguments of a call, checked against the parameters of what it calls; only those written."""
    by_name = {spec.name: spec for spec in specs}
    found: dict[str, float | str] = {}
    for argument in arguments:
        name = argument.name.text
        spec = by_name.get(name)
        if spec is None:
            report.error(
                "VDS022",
                argument.name.span,
                label=f"`{callee}` has no parameter `{name}`",
                help=f"it has {listing(by_name, last='and')}" if by_name else "it has no parameters at all",
                suggestion=nearest(name, by_name),
            )
            continue
        if name in found:
            report.error("VDS023", argument.span, label=f"`{name}` is given twice")
            continue
        if len(argument.values) != 1:
            report.error(
                "VDS024",
                argument.span,
                label=f"`{name}` takes one value, {len(argument.values)} are written",
                help="separate arguments with commas",
            )
            continue
        got = _argument(argument.values[0], spec, env, report)
        if got is None:
            continue
        if spec.choices is not None and isinstance(got, str) and got not in spec.choices:
            bad_word(argument.values[0].span, got, spec.choices, report)
            continue
        found[name] = got
    return found


def _argument(value: ast.Value, spec: ParameterSpec, env: Env, report: Report) -> float | str | None:
    """An argument's value; where a feature is a word or a number, whichever is written."""
    if spec.numbers is None:
        return evaluate(value, env, spec.kind, report)
    if isinstance(value, ast.Name) and isinstance(env.get(value.text, ""), str):
        return evaluate(value, env, "word", report)
    got = evaluate(value, env, "number", report)
    low, high = spec.numbers
    if isinstance(got, float) and not low <= got <= high:
        words = f", or {listing(spec.choices)}" if spec.choices else ""
        report.error(
            "VDS161",
            value.span,
            label=f"`{spec.name}` does not go that far",
            help=f"from {low:g} to {high:g}{words}",
        )
        return None
    return got


def read_parameters(parameters: Iterable[ast.Parameter], report: Report) -> tuple[ParameterSpec, ...]:
    """The parameters of a definition's head; a parameter's kind is that of its default."""
    specs: dict[str, ParameterSpec] = {}
    for parameter in parameters:
        name = parameter.name.text
        if name in specs:
            report.error("VDS023", parameter.span, label=f"the parameter `{name}` is there twice")
            continue
        if len(parameter.default) != 1:
            report.error(
                "VDS025",
                parameter.span,
                label=f"`{name}` needs one default",
                help=f"as in `{name} 1m` or `{name} oak`",
            )
            continue
        default = parameter.default[0]
        if isinstance(default, ast.Name | ast.Text):
            word = default.text if isinstance(default, ast.Name) else default.value
            specs[name] = ParameterSpec(name, "word", word)
            continue
        got = _number(default, {}, report)
        if got is not None:
            specs[name] = ParameterSpec(name, got.kind, got.value)
    return tuple(specs.values())


def parameter_env(
    specs: Iterable[ParameterSpec], arguments: Mapping[str, float | str] | None = None
) -> dict[str, Bound]:
    """Names for :func:`evaluate` from parameters: arguments where given, else defaults, with their kinds."""
    env: dict[str, Bound] = {}
    for spec in specs:
        value = (arguments or {}).get(spec.name, spec.default)
        kind = "number" if spec.kind == "word" else spec.kind  # a number in a word's place
        env[spec.name] = value if isinstance(value, str) else Quantity(float(value), kind)
    return env


def bad_word(span: Span, word: str, choices: Iterable[str], report: Report) -> None:
    """Report a word that is none of the choices."""
    choices = tuple(choices)
    meant = nearest(word, choices)
    report.error(
        "VDS026",
        span,
        label=f"`{word}` is none of the words for this",
        help=f"it may be {listing(choices)}",
        suggestion=meant,
        fix=meant,
    )


def _word(value: ast.Value, env: Env, want: str, report: Report) -> str | None:
    if isinstance(value, ast.Text):
        return value.value
    if isinstance(value, ast.Name):
        bound = env.get(value.text)
        if isinstance(bound, str):
            return bound
        if want == "word":
            return value.text
    report.error("VDS021", value.span, label=f"{_DESCRIBE[want]} is wanted here")
    return None


def _number(value: ast.Value, env: Env, report: Report) -> Quantity | None:
    """A value as a number of some kind."""
    if isinstance(value, ast.Number):
        return _literal(value, report)
    if isinstance(value, ast.Name):
        return _named(value, env, report)
    if isinstance(value, ast.Negate):
        inner = _number(value.value, env, report)
        return None if inner is None else Quantity(-inner.value, inner.kind)
    if isinstance(value, ast.Binary):
        return _binary(value, env, report)
    if isinstance(value, ast.Group) and len(value.items) == 1:
        inner = _number(value.items[0], env, report)
        if inner is not None and inner.kind == "number" and value.unit in UNIT_SCALE:
            return Quantity(inner.value * UNIT_SCALE[value.unit], UNIT_KIND[value.unit])
        return inner
    report.error("VDS021", value.span, label="a number is wanted here")
    return None


def _literal(value: ast.Number, report: Report) -> Quantity | None:
    if value.unit is None:
        return Quantity(value.value, "number")
    if value.unit not in UNIT_SCALE:
        report.error(
            "VDS021",
            value.span,
            label="frames are counted in the story, not here",
            help="use seconds, as in 0.5s",
        )
        return None
    return Quantity(value.value * UNIT_SCALE[value.unit], UNIT_KIND[value.unit])


def _named(value: ast.Name, env: Env, report: Report) -> Quantity | None:
    name = value.text
    bound = env.get(name)
    if isinstance(bound, Quantity):
        return bound
    if isinstance(bound, float | int):
        return Quantity(float(bound), "any")
    if bound is not None:
        report.error(
            "VDS021", value.span, label=f"`{name}` stands for the word `{bound}`, a number is wanted here"
        )
        return None
    numbers = [n for n, b in env.items() if not isinstance(b, str)]
    hint = "a minus between two values has spaces around it: `a - b`" if "-" in name else None
    report.error(
        "VDS027",
        value.span,
        label=f"no number is called `{name}` here",
        help=hint or (f"known here: {listing(numbers, last='and')}" if numbers else None),
        suggestion=nearest(name, numbers),
    )
    return None


def _binary(value: ast.Binary, env: Env, report: Report) -> Quantity | None:
    left, right = _number(value.left, env, report), _number(value.right, env, report)
    if left is None or right is None:
        return None
    if value.op in "+-":
        return _sum(value, left, right, report)
    if value.op == "/":
        if right.value == 0:
            report.error("VDS028", value.span, label="this divides by zero")
            return None
        kind = left.kind if right.kind == "number" else "number" if left.kind == right.kind else "any"
        return Quantity(left.value / right.value, kind)
    kinds = {left.kind, right.kind}
    kind = kinds.pop() if len(kinds) == 1 else (kinds - {"number"}).pop() if "number" in kinds else "any"
    return Quantity(left.value * right.value, kind)


def _sum(value: ast.Binary, left: Quantity, right: Quantity, report: Report) -> Quantity | None:
    sign = 1.0 if value.op == "+" else -1.0
    total = left.value + sign * right.value
    if left.kind == right.kind or right.kind == "any" or (right.kind == "number" and right.value == 0):
        return Quantity(total, left.kind if left.kind != "number" or right.kind == "number" else right.kind)
    if left.kind == "any" or (left.kind == "number" and left.value == 0):
        return Quantity(total, right.kind if right.kind != "number" else left.kind)
    report.error(
        "VDS021",
        value.span,
        label=f"{_DESCRIBE[left.kind]} and {_DESCRIBE[right.kind]} cannot be added",
        help="give both the same unit",
    )
    return None
