"""What the page shows, as plain values in the order they are shown in: ``storyboard.json`` put in words.

Assumes a document of schema ``vds.storyboard/1``. Guarantees values that need no further thought: the
template only lays them out, the page's script only shows and hides them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import groupby
from typing import Any

from ..cinema.measures import MEASURES
from ..cinema.moves import family
from ..cinema.telling import NOTES, is_good, number
from .reasons import TakeFacts, sentence
from .templating import url
from .words import seconds_words, timecode

Document = Mapping[str, Any]

#: Charts of the statistics: the field, its heading, and the filter that one of its words sets.
_CHARTS = (
    ("scales", "Shot sizes", "size"),
    ("movements", "Movements", "move"),
    ("angles", "Angles", "angle"),
    ("characters", "Shots a character acts in", "character"),
    ("scenes", "Shots a scene has", "scene"),
)
#: Takes of a strip that are shown before one asks for more.
STRIP = 5
#: Takes of a shot after which no more are drawn.
MOST = 40


def page_view(
    document: Document, plans: Mapping[str, Sequence[str]], scene_plans: Sequence[str] = ()
) -> dict[str, Any]:
    """Values of ``page.html.j2``; plans: SVG of a shot's takes, best first, by its id; and of scenes."""
    scenes = zip(document["scenes"], [*scene_plans, *[""] * len(document["scenes"])], strict=False)
    shots = [_shot(document, shot, n) for n, shot in enumerate(document["shots"], start=1)]
    drafted = sum(any(not take["video"] for take in shot["takes"]) for shot in shots)
    return {
        "title": document["title"] or "Untitled",
        "source": document["source"],
        "judge": _judge(document, drafted),
        "size": document["size"],
        "aspect": f"{document['size'][0]} / {document['size'][1]}",
        "length": seconds_words(document["statistics"]["frames"], document["fps"]),
        "average": f"{document['statistics']['mean_shot_seconds']:.1f} s",
        "statistics": document["statistics"],
        "shots": shots,
        "shown": [shot for shot in shots if shot["takes"]],
        "draft": document["draft"],
        "drafted": drafted,
        "groups": _groups(document, shots),
        "filters": _filters(document, shots),
        "charts": [c for c in (_chart(document, *chart) for chart in _CHARTS) if c["rows"]],
        "rejected": _rejected(document["statistics"]["rejected"]),
        "longest": max((s["seconds"] for s in shots), default=0.0) or 1.0,
        "cast": [_cast(document, name, shots) for name in document["characters"]],
        "sets": [_set(scene, shots) | {"plan": plan} for scene, plan in scenes],
        "cuts": [_cut(cut) for cut in document["continuity"]],
        "plans": plans,
        "strip": STRIP,
        "most": MOST,
        "board": _board(document, shots),
    }


def _judge(document: Document, drafted: int) -> str:
    """Who ranked the takes; of a draft's stills that is their geometry, whoever ranks the films."""
    judge = "the ranker" if document["judge"] == "ranker" else "their geometry"
    if not drafted or document["judge"] != "ranker":
        return judge
    filmed = sum(bool(shot["takes"]) for shot in document["shots"]) - drafted
    return f"{judge}, in the draft's stills by their geometry" if filmed else "their geometry, for this draft"


# --- shots ------------------------------------------------------------------------------------


def _shot(document: Document, shot: Document, n: int) -> dict[str, Any]:
    fps = tuple(document["fps"])
    takes = _takes(document, shot)
    beats = [b for b in (shot["story"], *shot["together"]) if b]
    trade = next((t["text"] for t in document["trades"] if t["shot"] == shot["id"]), "")
    cuts = [c["text"] for c in document["continuity"] if c["shots"][1] == shot["id"]]
    return {
        "id": shot["id"],
        "n": n,
        "line": shot["line"],
        "text": shot["text"],
        "scene": shot["scene"],
        "characters": sorted({b["char"] for b in beats}),
        "say": shot["say"],
        "note": shot["note"],
        "camera": _camera(shot["camera"]),
        "words": shot["camera"],
        "asked": " · ".join(_asked(shot["asked"][k]) for k in ("movement", "scale", "angle")),
        "frames": shot["frames"],
        "seconds": shot["frames"] * fps[1] / fps[0],
        "length": seconds_words(shot["frames"], fps),
        "start": shot["start"],
        "timecode": timecode(shot["start"], fps) if shot["start"] is not None else "",
        "proposals": shot["proposals"],
        "trade": trade,
        "cuts": cuts,
        "advice": shot["advice"],
        "rejected": _rejected(shot["rejected"]),
        "chosen": next((t["rank"] for t in takes if t["chosen"]), 0),
        "takes": takes,
    }


def _camera(words: Document) -> str:
    return " · ".join((words[k] or f"any {k}") for k in ("movement", "scale", "angle"))


def _asked(words: list[str]) -> str:
    return " or ".join(words) if len(words) <= 3 else "any"


def _rejected(counts: Mapping[str, int]) -> list[tuple[str, int]]:
    return sorted(
        ((why.replace("_", " "), n) for why, n in counts.items()), key=lambda row: (-row[1], row[0])
    )


# --- takes ------------------------------------------------------------------------------------


def _takes(document: Document, shot: Document) -> list[dict[str, Any]]:
    """The takes as they are shown; why each ranks where it does is told in the order of the scores."""
    facts = [_facts(take) for take in shot["takes"]]
    by_score = sorted(facts, key=lambda f: (-f.score, f.rank))
    told = {fact.rank: sentence(by_score, k) for k, fact in enumerate(by_score)}
    return [_take(document, take, told[take["rank"]]) for take in shot["takes"]]


def _facts(take: Document) -> TakeFacts:
    known = {name: value for name, value in take["measures"].items() if value is not None}
    words = {k: take[k] for k in ("movement", "scale", "angle")}
    measures = {name: 0.0 for name in MEASURES} | known
    score, judged = take["score"] or 0.0, (take["logit"], take["taste"])
    return TakeFacts(take["rank"], score, words, take["achieved"], measures, {}, *judged)


def _take(document: Document, take: Document, why: str) -> dict[str, Any]:
    return {
        "rank": take["rank"],
        "key": take["key"],
        "score": f"{take['score'] or 0.0:.2f}",
        "camera": _camera(take),
        "became": _became(take),
        "variant": take["variant"],
        "frames": take["frames"],
        "length": seconds_words(take["frames"], tuple(document["fps"])),
        "why": why,
        "chosen": bool(take.get("chosen")),
        "video": url(take["video"]) if take["video"] else "",
        "poster": url(take["poster"]),
        "track": url(take["track"]),
        "measures": _measures(take["measures"]),
    }


def _became(take: Document) -> str:
    """What the track came out as, where that is not what the take is called."""
    got = take["achieved"]
    if got is None:
        return ""
    other = [got[k] for k in ("scale", "angle") if got[k] != take[k]]
    moved = [] if family(got["movement"]) == family(take["movement"]) else [got["movement"]]
    return " · ".join(moved + other)


def _measures(measures: Document) -> list[dict[str, Any]]:
    """Measures in words, what is not as it should be first."""
    rows = [
        {"words": NOTES[name].good, "value": number(name, value), "fine": is_good(name, value)}
        for name, value in measures.items()
        if name in NOTES and value is not None
    ]
    return sorted(rows, key=lambda row: row["fine"])


# --- the film ---------------------------------------------------------------------------------


def _groups(document: Document, shots: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Shots that follow one another in one scene, under its name."""
    scenes = {s["name"]: s for s in document["scenes"]}
    groups = []
    for k, (name, members) in enumerate(groupby(shots, key=lambda s: s["scene"])):
        scene = scenes.get(name, {"set": "", "room": "", "time": ""})
        place = ", ".join(p.replace("_", " ") for p in (scene["set"], scene["room"].replace(".", ", ")) if p)
        groups.append({"key": k, "name": name, "place": place, "time": scene["time"], "shots": list(members)})
    return groups


def _filters(document: Document, shots: list[dict[str, Any]]) -> list[dict[str, Any]]:
    def kinds(words: Iterable[str | None]) -> list[str]:
        return list(dict.fromkeys(w for w in words if w))

    filters = (
        ("scene", "scene", [s["name"] for s in document["scenes"]]),
        ("character", "character", list(document["characters"])),
        ("size", "size", kinds(s["words"]["scale"] for s in shots)),
        ("angle", "angle", kinds(s["words"]["angle"] for s in shots)),
        ("move", "movement", sorted(kinds(s["words"]["movement"] for s in shots))),
    )
    return [{"key": key, "label": label, "words": words} for key, label, words in filters if len(words) > 1]


def _chart(document: Document, field: str, title: str, key: str) -> dict[str, Any]:
    counts = document["statistics"][field]
    most = max(counts.values(), default=1)
    rows = [(word, count, count / most) for word, count in counts.items()]
    return {"title": title, "key": key, "rows": rows}


def _cast(document: Document, name: str, shots: list[dict[str, Any]]) -> dict[str, Any]:
    """A character with a picture in which they act."""
    mine = [s for s in shots if name in s["characters"]]
    known = next((c for c in document.get("cast", ()) if c["name"] == name), None)
    return {
        "name": name,
        "looks": _looks(known) if known else "",
        "shots": len(mine),
        "seconds": f"{sum(s['seconds'] for s in mine):.1f} s",
        "poster": _portrait(name, document["shots"]),
    }


def _looks(known: Document) -> str:
    """``woman, height 1.68 m, hair bob``."""
    said = [
        f"{k} {v}" if isinstance(v, str) else f"{k} {v:g}" + (" m" if k == "height" else "")
        for k, v in known["arguments"].items()
        if v is not None
    ]
    return ", ".join([known["cast"], *said]).replace("_", " ")


def _portrait(name: str, shots: Sequence[Document]) -> str:
    """The still that shows somebody best: of a shot they act in first, seen, from near, by a camera that does
    not turn away.
    """
    near = ("close-up", "medium-close-up", "medium", "big-close-up", "cowboy", "medium-long", "full")

    def worse(shot: Document) -> tuple[bool, bool, int]:
        take = shot["takes"][0]
        seen = take["measures"].get("head_visible")
        turning = {"pan", "tilt"} & set(family(take["movement"]).split("+"))
        scale = near.index(take["scale"]) if take["scale"] in near else len(near)
        return shot["story"]["char"] != name, bool(turning) or (seen is not None and seen < 0.6), scale

    acting = [
        s for s in shots if s["takes"] and name in [b["char"] for b in (s["story"], *s["together"]) if b]
    ]
    return url(min(acting, key=worse)["takes"][0]["poster"]) if acting else ""


def _set(scene: Document, shots: list[dict[str, Any]]) -> dict[str, Any]:
    """A scene with the widest picture of it."""
    mine = [s for s in shots if s["scene"] == scene["name"]]
    shown = sorted(
        (s for s in mine if s["takes"]), key=lambda s: s["words"]["scale"] not in ("extreme-wide", "wide")
    )
    return {
        "name": scene["name"],
        "set": ", ".join(p for p in (scene["set"], scene["room"]) if p).replace("_", " "),
        "time": scene["time"],
        "shots": len(mine),
        "seconds": f"{sum(s['seconds'] for s in mine):.1f} s",
        "poster": shown[0]["takes"][0]["poster"] if shown else "",
    }


def _cut(cut: Document) -> dict[str, Any]:
    return {
        "rule": cut["rule"],
        "hint": cut["severity"] != "fault",
        "text": cut["text"],
        "into": cut["shots"][1],
    }


def _board(document: Document, shots: list[dict[str, Any]]) -> dict[str, Any]:
    """What the page's script needs to know."""
    kept = (
        "id",
        "n",
        "line",
        "text",
        "scene",
        "say",
        "note",
        "asked",
        "start",
        "proposals",
        "trade",
        "chosen",
    )
    return {
        "source": document["source"],
        "title": document["title"],
        "fps": document["fps"],
        "shots": [{k: s[k] for k in kept} | {"takes": s["takes"]} for s in shots],
    }
