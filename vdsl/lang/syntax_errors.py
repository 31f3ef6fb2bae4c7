# ruff: noqa: E501 (a table of prose; its lines are sentences)
"""What is said about a line that does not read: specific where the mistake is a known one.

:data:`RULES` is a table of malformed lines: each has an example, which is its test, a pattern that
knows it, and what to say. The first rule that knows the line speaks; the last resort names what has no
place and shows what such a line looks like.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from lark.exceptions import UnexpectedCharacters, UnexpectedInput, UnexpectedToken

from .diagnostics import Report, nearest
from .source import Span

FORMS: dict[str, str] = {
    "storyboard": 'storyboard "Morning coffee"',
    "header": "fps 24, size 1280x720, aspect 2.39, seed 7, rig cinema, style board, takes 5, proposals 80 or aperture 2.8",
    "use": 'use "common.vds"',
    "character": "character anna = woman(height 1.68m)",
    "scene": "scene kitchen = apartment.kitchen at dusk",
    "placement": "anna at door facing window",
    "transition": "cut, dissolve 12f, fade-out 1s, fade-in 1s or wipe",
    "story": "(anna walk counter) / (follow full eye-level) lens 50mm, 4s",
    "cameras": "/ (follow full eye-level) lens 50mm, 4s",
    "definition_head": "prop table(width 1.2m) { … }",
    "definition_file": 'prop lamp = "lamp.glb"',
    "entry": "box (1, 2, 3)m, at (0, 0, 0), color oak",
}


@dataclass(frozen=True)
class Rule:
    """A known mistake.

    example: a line that has it; marked: what the pattern's group 1 underlines in the example
    starts: the kinds of line it may be in, all where empty
    fix: what to put in place of what is marked; ``\\1``-style groups of the pattern
    """

    example: str
    marked: str
    starts: tuple[str, ...]
    pattern: str
    label: str
    help: str
    fix: str | None = None


_STORY = ("story", "cameras")
_N = r"[^\W\d][\w.-]*"

RULES: tuple[Rule, ...] = (
    # names of cameras with signs in them
    Rule("/ (static bird's eye)", "bird's eye", _STORY, r"/\s*\([^)]*?((?:bird|god)['’]s\s+eye(?:\s+view)?)", "this is one word",
         "say `overhead` or `birds-eye`", "overhead"),
    Rule("/ (static worm's eye)", "worm's eye", _STORY, r"/\s*\([^)]*?(worm['’]s\s+eye(?:\s+view)?)", "this is one word",
         "say `worms-eye`", "worms-eye"),
    Rule("/ (static medium 2-shot)", "2-shot", _STORY, r"/\s*\([^)]*?(?<!\w)(2[ -]?shot)\b", "this is spelt out", "say `two-shot`", "two-shot"),
    Rule("/ (360 medium)", "360", _STORY, r"/\s*\([^)]*?(?<!\w)(360(?:-shot)?)(?![\w.])", "no numbers inside the parentheses",
         "round somebody goes `arc`, `arc-left` or `arc-right`", "arc"),
    # signs no line has
    Rule("(anna wave) say “Hello.”", "“", (), r"([“”„«»])", "texts have straight quotes", 'use `"`', '"'),
    Rule("(anna wave) 4 s", "4 s", (), r"(?<![\w.-])(\d[\d.]*[ \t]+(?:mm|cm|m|deg|s|f))\b(?![\w-])", "the unit follows the number without a space",
         "as in `4s`"),
    Rule("(anna wave) say 'Hello.'", "'", (), r"(['’‘])", "texts have double quotes", 'use `"`', '"'),
    Rule("(anna wave) // she smiles", "//", (), r"(//)", "this is no comment", "comments begin with `#`", "#"),
    Rule("(anna walk) lens: 50mm", ":", (), r"(?<![\d ])(:)", "no colon here", "a name and its value stand side by side", ""),
    # story lines
    Rule("()", "()", ("story",), r"(\(\s*\))(?=[^)]*$)", "nobody does anything here", "as in `(anna walk door)`"),
    Rule("(anna walk door 3s)", "3s", ("story",), r"^\([^)/]*?\s(\d[\w.]*)", "no numbers inside the parentheses",
         "a duration stands after them: `(anna walk door) 4s`"),
    Rule("(anna / walk)", "/", ("story",), r"^\([^)]*(/)", "the camera stands outside of the parentheses", f"as in {FORMS['story']}"),
    Rule("(anna walk) + ben wave", "ben wave", ("story",), rf"\+\s*({_N}[^(/+]*?)\s*(?:$|[/+])", "what happens at the same time has parentheses too",
         "as in `(anna walk) + (ben wave)`"),
    Rule("(anna walk) +", "+", ("story",), r"(\+)\s*$", "something is missing after `+`", "as in `(anna walk) + (ben wave)`"),
    Rule("(anna walk) (static full eye-level)", "(", ("story",), r"^\([^()]*\)\s*(\()", "`/` or `+` is missing before this",
         "`/ (…)` is a camera, `+ (…)` happens at the same time"),
    Rule("(anna walk) & (ben wave)", "&", ("story",), r"\)\s*([&,]|and\b)\s*\(", "actions at the same time are joined by `+`",
         "as in `(anna walk) + (ben wave)`", "+"),
    Rule("(anna walk) - (static full eye-level)", "-", ("story",), r"\)\s*([-\\>|]+)\s*\(", "a camera follows a slash",
         f"as in {FORMS['story']}", "/"),
    # camera lines
    Rule("/ (static, full, eye-level)", ",", _STORY, r"/\s*\([^)]*?(,)", "no commas between the words of a camera",
         "as in `/ (static full eye-level)`", ""),
    Rule("/ (static full 50mm)", "50mm", _STORY, r"/\s*\([^)]*?\s(\d[\w.]*)", "no numbers inside the parentheses",
         "options stand after them: `/ (static full eye-level) lens 50mm`"),
    Rule("/", "/", _STORY, r"(/)\s*$", "the camera is missing after the slash", "as in `/ (follow full eye-level)`"),
    # options
    Rule("(anna walk) lens = 50mm", "=", _STORY, r"\)[^(]*?(=)", "no `=` in options", "as in `lens 50mm`", ""),
    Rule("(anna walk) lens 50mm,", ",", _STORY, r"(,)\s*$", "an option is missing after the comma", "or leave the comma out", ""),
    Rule('(anna wave) 4s say "Hello."', "say", _STORY, r"\)[^()]*[^\s(),]\s+(say|note|lens|ease|roll|focus|speed|style|proposals|takes|name)\s+\S",
         "a comma is missing before this", 'options are set apart, as in `4s, say "Hello."`', r", \1"),
    Rule("(anna walk) lens 50mm,, 4s", ",", _STORY, r",\s*(,)", "one comma is enough", "remove it", ""),
    Rule("(anna walk) lens (50mm)", "(", _STORY, rf"\)\s*(?:{_N}[^(/+]*)?{_N}\s+(\()", "options have no parentheses", "as in `lens 50mm`"),
    # headers
    Rule("storyboard Morning", "Morning", ("storyboard",), r"^storyboard\s+([^\"].*?)\s*$", "the title is a text in quotes",
         'as in `storyboard "Morning coffee"`', r'"\1"'),
    Rule('storyboard "A" "B"', '"B"', ("storyboard",), r'^storyboard\s+"[^"]*"\s*(.*?)\s*$', "a storyboard has one title", "remove the rest"),
    Rule("size 1280 720", "1280 720", ("header",), r"^size\s+(\d+\s*[*,/ ]\s*\d+)\s*$", "a size has an x between width and height",
         "as in `size 1280x720`"),
    Rule("fps = 24", "=", ("header",), r"^\S+\s*(=)", "no `=` in the header", "as in `fps 24`", ""),
    Rule("fps", "fps", ("header",), r"^(\S+)\s*$", "the value is missing", f"such lines are {FORMS['header']}"),
    Rule("fps 24, size 1280x720", ",", ("header",), r"(,)", "each header has a line of its own", "put the rest on the next line"),
    Rule("seed -3", "-3", ("header",), r"^\S+\s+(-\d[\w.]*)", "this number is not below zero", "as in `seed 7`"),
    Rule("use common.vds", "common.vds", ("use",), r"^use\s+([^\"].*?)\s*$", "the file is a text in quotes", 'as in `use "common.vds"`',
         r'"\1"'),
    Rule("use", "use", ("use",), r"^(use)\s*$", "the file is missing", 'as in `use "common.vds"`'),
    # characters
    Rule("character anna woman", "woman", ("character",), rf"^character\s+{_N}\s+({_N}.*?)\s*$", "`=` is missing before this",
         "as in `character anna = woman`", r"= \1"),
    Rule("character = woman", "=", ("character",), r"^character\s*(=)", "the character's name is missing",
         "as in `character anna = woman`"),
    Rule("character anna", "anna", ("character",), rf"^character\s+({_N})\s*=?\s*$", "who plays this character is missing",
         "as in `character anna = woman`"),
    Rule("character", "character", ("character",), r"^(character)\s*$", "the character's name is missing",
         "as in `character anna = woman`"),
    Rule("character anna = woman (height 1.7m)", "(", ("character",), rf"=\s*{_N}\s+(\()", "no space before this parenthesis",
         "as in `woman(height 1.7m)`"),
    Rule("character anna = woman(height = 1.7m)", "=", ("character",), r"\([^)]*?(=)", "no `=` inside the parentheses",
         "as in `woman(height 1.7m)`", ""),
    Rule("character anna = woman(1.7m)", "1.7m", ("character",), r"[(,]\s*(\d[\w.]*)", "which parameter this is for is missing",
         "as in `woman(height 1.7m)`"),
    Rule("character anna = woman height 1.7m", "height 1.7m", ("character",), rf"=\s*{_N}\s+([^(\s].*?)\s*$",
         "what a character looks like stands in parentheses", "as in `woman(height 1.7m)`", r"(\1)"),
    # scenes
    Rule("scene", "scene", ("scene",), r"^(scene)\s*$", "the scene's name is missing", f"as in `{FORMS['scene']}`"),
    Rule('scene "kitchen"', '"kitchen"', ("scene",), r'("[^"]*")', "names have no quotes", f"as in `{FORMS['scene']}`"),
    Rule("scene = apartment", "=", ("scene",), r"^scene\s*(=)", "the scene's name is missing", f"as in `{FORMS['scene']}`"),
    Rule("scene kitchen =", "=", ("scene",), r"(=)\s*$", "the set is missing", f"as in `{FORMS['scene']}`"),
    Rule("scene kitchen apartment.kitchen", "apartment.kitchen", ("scene",), rf"^scene\s+{_N}\s+({_N})", "`=` is missing before this",
         f"as in `{FORMS['scene']}`", r"= \1"),
    Rule("scene kitchen = apartment.kitchen dusk", "dusk", ("scene",), rf"=\s*{_N}\s+((?!at\b){_N})", "`at` is missing before the time of day",
         f"as in `{FORMS['scene']}`", r"at \1"),
    Rule("scene kitchen = apartment.kitchen at", "at", ("scene",), r"\s(at)\s*$", "the time of day is missing", "dawn, day, dusk or night"),
    Rule("scene kitchen = apartment.kitchen, night", ", night", ("scene",), r"=\s*[^,]*?(,\s*(?:at\s+)?\w+)\s*$", "no comma before the time of day",
         f"as in `{FORMS['scene']}`"),
    Rule("scene kitchen, night", ",", ("scene",), r"^[^=]*?(,)", "the set is missing", f"as in `{FORMS['scene']}`"),
    # placements
    Rule("anna at", "at", ("placement",), r"\s(at|on|in|by|near|beside|to|of|facing|holding)(?:\s+(?:the|a|an))?\s*$", "a name is missing after this", f"as in `{FORMS['placement']}`"),
    Rule("anna at (1, 2)m", "(", ("placement",), r"(\()", "people are placed at something that has a name", f"as in `{FORMS['placement']}`"),
    Rule("anna at door, facing window", ",", ("placement",), r"(,)", "no commas in a placement", f"as in `{FORMS['placement']}`", ""),
    # transitions
    Rule("dissolve to black", "to black", ("transition",), rf"^\S+\s+({_N}.*?)\s*$", "only a time follows a transition", f"as in {FORMS['transition']}"),
    # definitions
    Rule("box (1, , 3)m", ",", ("entry", "definition_head"), r"\((?:[^()]*,)?\s*(,)", "a value is missing here", "as in `(1, 2, 3)m`"),
    Rule("box (1, 2, 3)m,", ",", ("entry",), r"(,)\s*$", "an option is missing after the comma", "one entry is one line", ""),
    Rule("box (1, 2, 3)m,, at (0, 0, 0)", ",", ("entry",), r",\s*(,)", "one comma is enough", "remove it", ""),
    Rule("box (1 2 3)m", "2", ("entry", "definition_head"), r"\(\s*-?\d[\w.]*\s+(-?\d[\w.]*)", "a comma is missing before this", "as in `(1, 2, 3)m`", r", \1"),
    Rule("box (), at (0, 0, 0)", "()", ("entry",), r"(\(\s*\))", "these parentheses hold nothing", "as in `(1, 2, 3)m`"),
    Rule("prop", "prop", ("definition_head", "definition_file"), r"^(set|prop|cast|action)\s*$", "the name is missing", f"as in `{FORMS['definition_head']}`"),
    Rule("prop table (width 1m)", "(", ("definition_head",), rf"^\w+\s+{_N}\s+(\()", "no space before this parenthesis", f"as in `{FORMS['definition_head']}`"),
    Rule("prop table(width = 1m)", "=", ("definition_head",), r"\([^)]*?(=)", "no `=` before a default", f"as in `{FORMS['definition_head']}`", ""),
    Rule('prop "table"', '"table"', ("definition_head",), r'^\w+\s+("[^"]*")', "names have no quotes", f"as in `{FORMS['definition_head']}`"),
    Rule("set kitchen = apartment.kitchen", "set", ("definition_file",), rf"^(set)\s+{_N}\s*=\s*(?![^\"]*\.glb\b){_N}\s*(?:\bat\s+\w+\s*)?$",
         "a place of the library is opened by `scene`", f"as in `{FORMS['scene']}`", "scene"),
    Rule("prop lamp = lamp.glb", "lamp.glb", ("definition_file",), r"=\s*([^\"\s].*?)\s*$", "the file is a text in quotes",
         f"as in `{FORMS['definition_file']}`", r'"\1"'),
)  # fmt: skip


def explain_syntax(error: UnexpectedInput, start: str, line: Span, report: Report) -> None:
    """Report one syntax error of a logical line read with the start rule ``start``."""
    text = line.text
    for rule in RULES:
        if rule.starts and start not in rule.starts:
            continue
        match = re.search(rule.pattern, _blank(text, rule.pattern))
        if match is None:
            continue
        span = Span(line.source, line.start + match.start(1), line.start + match.end(1))
        fix = None if rule.fix is None else rule.fix.replace("\\1", span.text)
        report.error("VDS001", span, label=rule.label, help=rule.help, fix=fix)
        return
    span, label = _last_resort(error, line)
    report.error("VDS001", span, label=label, help=f"such a line looks like: {FORMS[start]}")


def _blank(text: str, pattern: str) -> str:
    """The text with comments, and (for patterns not about them) what is in quotes, blanked out."""
    quoted = '"' in pattern
    return re.sub(
        r'("[^"\n]*")|#[^\n]*',
        lambda m: m.group() if m.group(1) and quoted else '"' + "_" * (len(m.group()) - 2) + '"'
        if m.group(1)
        else " " * len(m.group()),
        text,
    )  # fmt: skip


def _last_resort(error: UnexpectedInput, line: Span) -> tuple[Span, str]:
    source = line.source
    if isinstance(error, UnexpectedToken) and error.token.type != "$END":
        at = line.start + (error.token.start_pos or 0)
        span = Span(source, at, min(at + len(error.token), line.end))
    elif isinstance(error, UnexpectedCharacters):
        at = line.start + (error.pos_in_stream or 0)
        span = Span(source, at, min(at + 1, line.end))
    else:
        return Span(source, max(line.start, line.end - 1), line.end), "the line ends too early"
    shown = span.text if len(span.text) <= 24 else span.text[:24] + "…"
    return span, f"`{shown}` has no place here"


STATEMENT_WORDS = ("storyboard", "character", "scene", "use", "set", "prop", "cast", "action", "cut", "dissolve",
                   "fade-out", "fade-in", "wipe", "fps", "size", "aspect", "seed", "rig", "style", "takes",
                   "proposals", "aperture")  # fmt: skip

#: What stands on the title page of a screenplay beside the title.
_TITLE_PAGE = (
    "author",
    "authors",
    "credit",
    "date",
    "draft",
    "source",
    "contact",
    "copyright",
    "notes",
    "revision",
)


def unknown_statement(line: Span, word: str | None, report: Report) -> None:
    """A line that begins like no statement."""
    text = line.text
    span = Span(line.source, line.start, line.start + len(word or text[:1]))
    meant = nearest(word, STATEMENT_WORDS) if word else None
    first = text.split("\n")[0].strip()
    heading = re.match(r"(?:INT|EXT)\b[./ ]", first)
    speech = re.fullmatch(r'([^\W\d][\w-]*)(?:\s*:\s*([^"]+|"[^"]*")|\s*("[^"]*"))', first)
    if heading or (speech and meant is None):
        whole = Span(line.source, line.start, line.start + len(first))
        words = (speech[2] or speech[3]).strip().strip('"') if speech else ""
        key = speech[1].lower() if speech else ""
        fix: str | None = None
        if key == "title":
            fix = f'storyboard "{words}"'
            help = f"the title of a storyboard is said by `{fix}`"
        elif key in _TITLE_PAGE:
            fix = f"# {first}"
            help = f"what is for readers alone is a comment: `{fix}`"
        elif speech:
            fix = f'({speech[1]} talk) say "{words}"'
            help = f"what somebody says stands behind what they do: `{fix}`"
        else:
            help = f"a place opens as in `{FORMS['scene']}`"
        report.error("VDS013", whole, label="no line begins like this", help=help, fix=fix)
        return
    if word and meant is None and first == word:
        report.error(
            "VDS013", span, label="no line begins like this",
            help=f"where somebody is when the scene opens is said by `{word} at door`, what they do by `({word} wave)`",
        )  # fmt: skip
        return
    if word and meant is None and re.fullmatch(r"[\w .-]{3,80}", first):
        report.error(
            "VDS013", Span(line.source, line.start, line.start + len(first)), label="no line begins like this",
            help=f"what someone does stands in parentheses: `({first})`", fix=f"({first})",
        )  # fmt: skip
        return
    if first.startswith('"'):
        help = 'what somebody says stands behind what they do, as in `(anna talk) say "…"`'
    elif text.startswith("*") or text.startswith("-"):
        help = "lists have no marks; each statement is a line of its own"
    else:
        help = "a story line is `(anna walk door)`, a camera line `/ (static full eye-level)`"
    report.error("VDS013", span, label="no line begins like this", help=help, suggestion=meant, fix=meant)
