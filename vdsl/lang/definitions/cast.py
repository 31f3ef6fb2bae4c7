"""Cast: from the definition of a kind of person to what is known of one.

``cast NAME(parameters) { entries }``: a parameter or an entry named like a feature of
:mod:`vdsl.lang.definitions.looks` sets that feature; an entry's value may name a parameter. A feature
named by neither is a parameter all the same, so that anybody may wear anything. Assumes a parsed
definition; guarantees that a mistake is reported at its place and its feature left at its default.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from .. import ast
from ..diagnostics import Report, listing, nearest
from ..evaluate import Bound, bad_word, evaluate, parameter_env, read_parameters
from .looks import FEATURES, NUMBERS
from .reader import Reader
from .types import DefinitionBase, ParameterSpec

#: What a feature is where neither a parameter nor an entry says so.
DEFAULTS: dict[str, float | str] = {
    "height": 1.72,
    "build": "average",
    "body": "neutral",
    "age": "adult",
    "skin": "light",
    "eyes": "brown",
    "hair": "short",
    "hair-color": "brown",
    "facial-hair": "none",
    "glasses": "no",
    "top": "crimson",
    "top-kind": "tshirt",
    "shirt": "cream",
    "bottom": "navy",
    "bottom-kind": "trousers",
    "shoes": "black",
    "shoes-kind": "shoes",
    "hat": "none",
    "hat-color": "navy",
    "neck": "none",
    "over": "none",
    "back": "none",
    "belt": "no",
    "gloves": "no",
    "badge": "no",
    "accent": "crimson",
}


@dataclass(frozen=True)
class CastDef(DefinitionBase):
    """A kind of person as defined.

    body: its entries; own: how many of the parameters are written in its head (entries may name these)
    """

    body: tuple[ast.Entry, ...] = field(compare=False, repr=False)
    own: int

    def features(
        self, arguments: Mapping[str, float | str] | None = None, report: Report | None = None
    ) -> dict[str, float | str]:
        """Every feature of one person: words, and numbers in metres and years."""
        env = parameter_env(self.parameters[: self.own], arguments)
        report = Report() if report is None else report
        return _features(self.body, self.parameters, arguments or {}, env, report)


def read_cast(definition: ast.Definition, report: Report) -> CastDef | None:
    """Check a cast definition, with its defaults filled in."""
    written = read_parameters(definition.parameters, report)
    defaults = {p.name.text: p.default[0].span for p in definition.parameters if p.default}
    parameters = []
    for spec in written:
        checked = replace(spec, choices=FEATURES.get(spec.name)) if spec.kind == "word" else spec
        if spec.name in NUMBERS and spec.name != "height":
            checked = replace(spec, choices=FEATURES[spec.name], numbers=NUMBERS[spec.name])
        span = defaults.get(spec.name, definition.span)
        if isinstance(spec.default, str):
            if checked.choices is not None and spec.default not in checked.choices:
                bad_word(span, spec.default, checked.choices, report)
                checked = replace(checked, default=DEFAULTS[spec.name])
            elif spec.name == "height":
                report.error("VDS161", span, label="a height is a length", help="such as `height 1.7m`")
                checked = ParameterSpec("height", "length", DEFAULTS["height"])
        else:
            problem = _out_of_range(spec.name, float(spec.default), spec.kind)
            if problem is not None:
                report.error("VDS161", span, label=problem[0], help=problem[1])
                kind = "length" if spec.name == "height" else "word"
                checked = ParameterSpec(spec.name, kind, DEFAULTS[spec.name], FEATURES[spec.name])
        parameters.append(checked)
    own = len(parameters)
    said = {p.name for p in parameters} | {e.head.text for e in definition.body}
    parameters += [_unsaid(name) for name in FEATURES if name not in said]
    made = CastDef(definition.name.text, tuple(parameters), definition.span, definition.body, own)
    made.features(report=report)
    return made


def _unsaid(name: str) -> ParameterSpec:
    """The parameter of a feature that a definition does not mention."""
    if name == "height":
        return ParameterSpec(name, "length", DEFAULTS[name])
    return ParameterSpec(name, "word", DEFAULTS[name], FEATURES[name], NUMBERS.get(name))


def _out_of_range(name: str, value: float, kind: str) -> tuple[str, str] | None:
    """What is wrong with a number for a feature, and how to put it right; None for nothing."""
    if name not in FEATURES:
        return None
    if name not in NUMBERS:
        return f"`{name}` is a word, not a number", f"it may be {listing(FEATURES[name] or ())}"
    low, high = NUMBERS[name]
    if (kind == "length") != (name == "height"):
        unit = "a length such as 1.7m" if name == "height" else "a bare number or a word"
        return f"`{name}` is {unit}", f"from {low:g} to {high:g}"
    if not low <= value <= high:
        unit = "m" if name == "height" else ""
        return f"`{name}` does not go that far", f"from {low:g}{unit} to {high:g}{unit}"
    return None


def _features(
    body: tuple[ast.Entry, ...],
    parameters: tuple[ParameterSpec, ...],
    arguments: Mapping[str, float | str],
    env: Mapping[str, Bound],
    report: Report,
) -> dict[str, float | str]:
    found = dict(DEFAULTS)
    seen: set[str] = set()
    for entry in body:
        name = entry.head.text
        if name not in FEATURES:
            report.error(
                "VDS160",
                entry.head.span,
                label=f"people have no `{name}`",
                help=f"there are {listing(FEATURES, 30)}",
                suggestion=nearest(name, FEATURES),
            )
            continue
        if name in seen:
            report.error("VDS023", entry.span, label=f"`{name}` is said twice")
            continue
        seen.add(name)
        value = _entry_value(name, entry, env, report)
        if value is not None:
            found[name] = value
    for spec in parameters:
        if spec.name in FEATURES and spec.name not in seen:
            found[spec.name] = arguments.get(spec.name, spec.default)
    return found


def _entry_value(name: str, entry: ast.Entry, env: Mapping[str, Bound], report: Report) -> float | str | None:
    reader = Reader(entry, env, report)
    value = reader.value(0)
    reader.done()
    if value is None:
        reader.missing("a value")
        return None
    if name in NUMBERS and (isinstance(value, ast.Number) or name == "height"):
        want = "length" if name == "height" else "number"
        number = evaluate(value, env, want, report)
        if not isinstance(number, float):
            return None
        problem = _out_of_range(name, number, want)
        if problem is not None:
            report.error("VDS161", value.span, label=problem[0], help=problem[1])
            return None
        return number
    if name in NUMBERS and isinstance(value, ast.Name):
        bound = env.get(value.text)
        if bound is not None and not isinstance(bound, str):
            number = evaluate(value, env, "number", report)
            return number if isinstance(number, float) else None
    word = evaluate(value, env, "word", report)
    choices = FEATURES[name]
    if not isinstance(word, str) or choices is None:
        return None
    if word not in choices:
        bad_word(value.span, word, choices, report)
        return None
    return word
