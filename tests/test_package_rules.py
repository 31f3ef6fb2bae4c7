"""Who may import whom: data flows one way, so do imports."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("grammar", "runtime", "ranker", "vdsl")
#: From the ground up: each may import those before it.
LAYERS = ("lang", "library", "stage", "cinema", "propose", "emit", "pipeline", "cli")


def _module(path: Path) -> tuple[str, ...]:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return parts[:-1] if parts[-1] == "__init__" else parts


def _imports(path: Path) -> set[tuple[str, ...]]:
    """Absolute module paths imported anywhere in a file, also inside functions."""
    package = path.relative_to(ROOT).parent.parts
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            found.update(tuple(alias.name.split(".")) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = tuple(node.module.split(".")) if node.module else ()
            if node.level:
                base = package[: len(package) - (node.level - 1)] + base
            found.update((*base, alias.name) for alias in node.names)
    return found


def _edges() -> list[tuple[Path, tuple[str, ...], tuple[str, ...]]]:
    files = [p for package in PACKAGES for p in (ROOT / package).rglob("*.py")]
    return [(p, _module(p), target) for p in files for target in _imports(p)]


def _layer(module: tuple[str, ...]) -> int | None:
    if module[0] == "vdsl" and len(module) > 1 and module[1] in LAYERS:
        return LAYERS.index(module[1])
    return None


def test_imports_run_one_way():
    edges = _edges()
    ours = [(path, source, target) for path, source, target in edges if target[0] in PACKAGES]
    assert len(ours) > 150, "the walk saw too few imports to mean anything"
    wrong = []
    for path, source, target in ours:
        if source[0] != "vdsl" and target[0] != source[0]:
            wrong.append((path, ".".join(target)))
        a, b = _layer(source), _layer(target)
        if a is not None and b is not None and b > a:
            wrong.append((path, ".".join(target)))
    assert not wrong, "\n".join(f"{p.relative_to(ROOT)} imports {t}" for p, t in wrong)


@pytest.mark.parametrize(
    ("library", "allowed"), [("torch", "ranker"), ("torchvision", "ranker"), ("taichi", "runtime/raster")]
)
def test_heavy_libraries_stay_in_their_room(library, allowed):
    users = {p.relative_to(ROOT).as_posix() for p, _, target in _edges() if target[0] == library}
    assert users, f"nobody imports {library}: the walk is broken"
    assert all(u.startswith(allowed + "/") for u in users), users


def test_checking_loads_no_heavy_library():
    code = (
        "import sys, vdsl.cli, vdsl.lang, vdsl.library\n"
        "from vdsl.cli.check import check\n"
        "late = {'numpy', 'torch', 'taichi', 'cv2', 'av', 'scipy', 'skimage', 'jinja2'}\n"
        "late |= {'starlette', 'uvicorn', 'anyio', 'watchfiles'}\n"
        "heavy = late & set(sys.modules)\n"
        "sys.exit(f'loaded: {sorted(heavy)}' if heavy else 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT)
    assert done.returncode == 0, done.stderr


def test_the_wheel_holds_every_package_and_its_data():
    """Data files must lie inside the packages the wheel lists, or an installed copy lacks them."""
    assert list((ROOT / "grammar").glob("*.lark"))
    for kind in ("sets", "props", "cast", "actions"):
        assert list((ROOT / "vdsl" / "library" / kind).glob("*.vds")), kind
