"""For authors: ``.venv/bin/python tests/motion/check_action.py NAME…`` performs every variant of library
actions from their examples, by a tall heavy man and by a small woman and a child, and prints what is wrong.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parents[1]), str(Path(__file__).resolve().parents[2])]

from motion.checks import Measures, measure, violations  # noqa: E402
from vdsl.lang import Report, Source  # noqa: E402
from vdsl.library import Catalog  # noqa: E402
from vdsl.pipeline.compile import stage_acts  # noqa: E402
from vdsl.pipeline.script import ScriptError, check_source  # noqa: E402
from vdsl.pipeline.trial import NoTrialError, action_script  # noqa: E402
from vdsl.propose.story import motions  # noqa: E402

#: Who acts and who the other one is.
BODIES = {
    "tall heavy man": ("man(height 1.93m, build 85%)", "woman(height 1.55m)"),
    "small woman": ("woman(height 1.52m, build 25%)", "man(height 1.85m)"),
}


def checked(name: str, catalog: Catalog, bodies: tuple[str, str]) -> Iterator[tuple[str, str, Measures]]:
    """(variant, person, measures) for every variant of an action."""
    definition = catalog.get("action", name)
    if definition is None:
        raise NoTrialError(f"there is no action `{name}`")
    text = action_script(definition, catalog, bodies)  # type: ignore[arg-type]
    report = Report()
    try:
        (act,) = stage_acts(check_source(Source(name, text), report))
    except ScriptError as error:
        raise NoTrialError(f"`{name}`: {[(d.code, d.label) for d in error.report.errors]}") from error
    found = motions(act.state, act.line, act.filming, report, most=64)
    if report.has_errors:
        raise NoTrialError(f"`{name}`: {[(d.code, d.label) for d in report.errors]}")
    seen = set()
    for variant, motion in found:
        if variant in seen:
            continue
        seen.add(variant)
        for who, skeleton in act.filming.skeletons.items():
            yield variant, who, measure(motion, who, skeleton, act.filming.fps, act.state.world)


def main(names: list[str]) -> int:
    catalog = Catalog(Report())
    wrong = 0
    for name in names or list(catalog.names("action")):
        for body, bodies in BODIES.items():
            try:
                for variant, who, measures in checked(name, catalog, bodies):
                    for what in violations(measures):
                        wrong += 1
                        print(f"{name} {variant}, {who} ({body}): {what}")
            except NoTrialError as error:
                wrong += 1
                print(error)
                break
    print("all sound" if not wrong else f"{wrong} things to mend")
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
