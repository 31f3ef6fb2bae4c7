"""The templates of the pages: one environment that escapes everything, and files put into the page itself.

Guarantees that nothing a writer typed becomes markup or script: text is escaped, and only the scripts
of the template run (their digests stand in the page's content policy).
"""

from __future__ import annotations

import base64
import hashlib
from functools import lru_cache
from pathlib import Path
from typing import Any
from urllib.parse import quote

import jinja2
from markupsafe import Markup

FOLDER = Path(__file__).parent / "templates"


def rendered(template: str, **values: Any) -> str:
    """A template of :data:`FOLDER` with its values."""
    return _environment().get_template(template).render(**values)


def url(path: Any) -> str:
    """A relative path as it stands in a link."""
    return quote(str(path).encode("utf-8", "replace"))


@lru_cache(maxsize=1)
def _environment() -> jinja2.Environment:
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(FOLDER),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["url"] = url
    environment.filters["spaced"] = lambda words: str(words).replace("_", " ")
    environment.globals["style"] = _style
    environment.globals["script"] = _script
    environment.globals["policy"] = _policy
    return environment


def _style(*names: str) -> Markup:
    return Markup("<style>\n" + _text(names) + "</style>")


def _script(*names: str) -> Markup:
    return Markup("<script>" + _text(names) + "</script>")


def _policy(*scripts: list[str]) -> Markup:
    """Of all scripts only these run; each is a list of files that are put in as one."""
    digests = (hashlib.sha256(_text(tuple(names)).encode()).digest() for names in scripts)
    allowed = " ".join(f"'sha256-{base64.b64encode(digest).decode()}'" for digest in digests)
    rules = (f"script-src {allowed}", "object-src 'none'", "base-uri 'none'", "form-action 'self'")
    return Markup('<meta http-equiv="Content-Security-Policy" content="' + "; ".join(rules) + '">')


def _text(names: tuple[str, ...]) -> str:
    """Our own files, one after another; whole, so that neither element can be ended by them."""
    text = "\n".join((FOLDER / name).read_text("utf-8") for name in names)
    if "</" in text:
        raise ValueError(f"{names}: a file that is put into the page must not hold an end tag")
    return text
