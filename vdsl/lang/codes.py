# ruff: noqa: E501 (a table of prose; its lines are sentences)
"""The table of diagnostic codes: a title, why, a wrong and a right example (``vdsc explain``).

Ranges: VDS001-099 the language, VDS100-139 sets and props, VDS140-159 actions, VDS160-169 the cast,
VDS200-219 files of other programs.
The examples of VDS001-099 are tests: the wrong one gives its code, the right one no error at all.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Code:
    """title: a few words, lower case; why: a paragraph or two; wrong, right: lines of a script."""

    title: str
    why: str
    wrong: str = ""
    right: str = ""


CODES: dict[str, Code] = {
    # -- lines and signs -----------------------------------------------------------------
    "VDS001": Code(
        "this line does not read",
        "A line of a script is one statement, and this one has something that has no place in its kind of "
        "statement, or ends too early. The message shows what such a line looks like.",
        "(anna walk counter) lens = 50mm",
        "(anna walk counter) lens 50mm",
    ),
    "VDS002": Code(
        "parenthesis without its partner",
        "Every `(` has its `)`. In the story they are on the same line; inside a definition a value in "
        "parentheses may run over several lines.",
        "(anna walk counter",
        "(anna walk counter)",
    ),
    "VDS003": Code(
        "brace without its partner",
        "The braces of a definition hold its entries. The opening brace stands at the end of the line it belongs "
        "to, the closing one where the definition ends.",
        "prop shelf_a {\n    box (1, 1, 1)m",
        "prop shelf_a {\n    box (1, 1, 1)m\n}",
    ),
    "VDS004": Code(
        "text without its closing quote",
        'A text stands between two `"` on one line. A quote inside is written `\\"`.',
        '(anna wave) say "Hello.',
        '(anna wave) say "Hello."',
    ),
    "VDS005": Code(
        "line too long",
        "A line may have 20,000 characters. What is longer is no line somebody wrote; perhaps the file is no script.",
    ),
    "VDS006": Code(
        "nested too deeply",
        "Values and braces may stand inside each other, but not without end.",
    ),
    "VDS007": Code(
        "`;` outside a definition",
        "A semicolon separates entries inside the braces of a definition. In the story each statement has a line "
        "of its own.",
        "(anna wave); (ben wave)",
        "(anna wave)\n(ben wave)",
    ),
    "VDS008": Code(
        "unknown unit",
        "Numbers have units: m, cm, mm for lengths, deg for angles, s and f (frames) for times, % for shares; "
        "the unit follows the number without a space.",
        "(anna walk) 4sec",
        "(anna walk) 4s",
    ),
    "VDS009": Code(
        "said twice in one placement",
        "A placement says once where, once in which direction and once in which posture.",
        "carl at counter at chair_1",
        "carl at counter",
    ),
    "VDS010": Code(
        "`|` without a word on both sides",
        "A bar joins the words of a choice: the compiler proposes each of them.",
        "(anna walk) / (push| medium eye-level)\n(anna walk) / (|push medium eye-level)",
        "(anna walk) / (push|static medium eye-level)",
    ),
    "VDS011": Code(
        "braces in the story",
        "Only definitions (set, prop, cast, action) have braces. The story is one statement a line.",
        "scene kitchen = apartment.kitchen {\n}",
        "scene kitchen = apartment.kitchen",
    ),
    "VDS012": Code(
        "definition without a body",
        "A definition has its entries in braces, the opening brace on the line of its head.",
        "prop shelf_a",
        "prop shelf_a {\n    box (1, 1, 1)m\n}",
    ),
    "VDS013": Code(
        "no statement begins like this",
        "A line begins with a word of the language (storyboard, character, scene, cut …), with a character who is "
        "placed (`anna at door`), with `(` for what happens or with `/` for a camera.",
        "charakter carla = woman",
        "character carla = woman",
    ),
    # -- files -----------------------------------------------------------------------------
    "VDS014": Code(
        "this is no text file",
        "Scripts are UTF-8 text. A byte-order mark and Windows line ends are fine. Other encodings and binary "
        "files are not read.",
    ),
    "VDS015": Code(
        "path outside the project",
        "Files are named relative to the script and stay inside its folder, so that a script cannot reach into "
        "the rest of the machine, and a project can be moved as a whole.",
        'use "../other/common.vds"',
        "",
    ),
    "VDS016": Code(
        "file cannot be read",
        "The file a `use` line names is missing or may not be read. The path is relative to the file it is "
        "written in.",
        'use "no_such_file.vds"',
        "",
    ),
    "VDS018": Code(
        "defined twice",
        "Within a file a name stands for one definition of its kind. A definition of yours may have the name of "
        "one in the library: then yours is taken.",
        "prop a { box (1, 1, 1)m }\nprop a { box (2, 1, 1)m }",
        "prop a { box (1, 1, 1)m }\nprop b { box (2, 1, 1)m }",
    ),
    # -- values ----------------------------------------------------------------------------
    "VDS020": Code(
        "a unit is missing",
        "A bare number where a length, an angle or a time is wanted could mean anything, so it is not guessed. "
        "Only 0 needs no unit.",
        "(anna walk) lens 50",
        "(anna walk) lens 50mm",
    ),
    "VDS021": Code(
        "the wrong kind of value",
        "A length was wanted and an angle is written, or a number and a word, or two kinds are added up.",
        "character carla = woman(height 90deg)",
        "character carla = woman(height 1.7m)",
    ),
    "VDS022": Code(
        "unknown parameter",
        "Props and cast have the parameters their definition names, and no others.",
        "character carla = woman(hight 1.7m)",
        "character carla = woman(height 1.7m)",
    ),
    "VDS023": Code(
        "given twice",
        "An argument, a parameter or an option is written once.",
        "character carla = woman(height 1.7m, height 1.8m)",
        "character carla = woman(height 1.7m)",
    ),
    "VDS024": Code(
        "one value is wanted",
        "What is written has no value, or several where one is taken. Options and arguments are separated by commas.",
        "character carla = woman(height 1.7m hair bob)",
        "character carla = woman(height 1.7m, hair bob)",
    ),
    "VDS025": Code(
        "parameter without a default",
        "A parameter in the head of a definition has a default: it says what kind of value it is, too.",
        "prop shelf_a(width) { box (1, 1, 1)m }",
        "prop shelf_a(width 1m) { box (width, 1m, 1m) }",
    ),
    "VDS026": Code(
        "not one of the words",
        "Where there are fixed words to choose from, it must be one of them.",
        "character carla = woman(build big)",
        "character carla = woman(build heavy)",
    ),
    "VDS027": Code(
        "unknown number",
        "Names in arithmetic are the parameters of the definition and the counters of `repeat`. As `-` may be part "
        "of a name, a minus between two values has spaces around it.",
        "prop shelf_a(width 1m) { box (widht, 1m, 1m) }",
        "prop shelf_a(width 1m) { box (width, 1m, 1m) }",
    ),
    "VDS028": Code(
        "division by zero",
        "The value after `/` comes out as 0.",
        "prop shelf_a(width 1m) { box (width / 0, 1m, 1m) }",
        "prop shelf_a(width 1m) { box (width / 2, 1m, 1m) }",
    ),
    # -- entries of definitions --------------------------------------------------------------
    "VDS029": Code(
        "something is missing in this entry",
        "The entry needs a value that is not written.",
        "prop shelf_a { box }",
        "prop shelf_a { box (1, 1, 1)m }",
    ),
    "VDS030": Code(
        "unknown option of an entry",
        "Options nobody reads would be silently without effect, so they are errors.",
        "prop shelf_a { box (1, 1, 1)m, colour oak }",
        "prop shelf_a { box (1, 1, 1)m, color oak }",
    ),
    "VDS031": Code(
        "a value nobody takes",
        "The entry has more than it can use; often a comma is missing.",
        "prop shelf_a { box (1, 1, 1)m oak }",
        "prop shelf_a { box (1, 1, 1)m, color oak }",
    ),
    "VDS032": Code(
        "the wrong count of numbers",
        "A point on the floor has two numbers, one in space and a size have three.",
        "prop shelf_a { box (1, 1)m }",
        "prop shelf_a { box (1, 1, 1)m }",
    ),
    "VDS033": Code(
        "unknown entry",
        "Each kind of definition has its own entries; `docs/language.md` lists them.",
        "prop shelf_a { bocks (1, 1, 1)m }",
        "prop shelf_a { box (1, 1, 1)m }",
    ),
    # -- the file as a whole -----------------------------------------------------------------
    "VDS034": Code(
        "nothing happens in this script",
        "A story needs a scene and something that happens in it. A first script to type:\n\n"
        '    storyboard "Hello"\n'
        "    character anna = woman\n"
        "    scene kitchen = apartment.kitchen\n"
        "    anna at door\n"
        "    (anna walk counter) / (follow full eye-level)",
    ),
    "VDS035": Code(
        "header line out of place",
        "The header (storyboard, fps, size, aspect, seed, rig, style, aperture, takes, proposals) stands before the "
        "first scene, each of its lines at most once.",
        "fps 24\nfps 25",
        "fps 24",
    ),
    "VDS036": Code(
        "bad value in the header",
        "Each header line takes one kind of value: `fps 24`, `size 1280x720`, `aspect 2.39`, `seed 7`, "
        "`rig cinema`, `style board`, `takes 5`, `proposals 80`, `aperture 2.8`.",
        "fps 1000",
        "fps 24",
    ),
    "VDS037": Code(
        "odd picture size",
        "Video is stored with half as many colour samples as pixels in each direction, so that width and height "
        "are even.",
        "size 1279x720",
        "size 1280x720",
    ),
    # -- the camera --------------------------------------------------------------------------
    "VDS040": Code(
        "unknown camera word",
        "A camera line has a movement (static, follow, push, pull, zoom, tilt, pan, dolly, pedestal, arc, "
        "crane, roll, dolly-zoom, handheld, whip-pan, rack-focus, or two joined as in push+pan), a scale "
        "(extreme-close-up, big-close-up, close-up, medium-close-up, medium, cowboy, medium-long, full, wide, "
        "extreme-wide) and an angle (eye-level, high-angle, low-angle, overhead, worms-eye, shoulder-level, "
        "hip-level, knee-level, ground-level). Each may be `*`, a choice like push|static, or left out.",
        "(anna walk) / (folow full eye-level)",
        "(anna walk) / (follow full eye-level)",
    ),
    "VDS042": Code(
        "two camera words of one kind",
        "A camera line has one movement, one scale and one angle. Several to choose from are joined by a bar.",
        "(anna walk) / (push static medium eye-level)",
        "(anna walk) / (push|static medium eye-level)",
    ),
    "VDS043": Code(
        "one `*` too many",
        "A `*` takes the place of a movement, a scale or an angle that is not said otherwise.",
        "(anna walk) / (push medium eye-level *)",
        "(anna walk) / (push * eye-level)",
    ),
    "VDS044": Code(
        "MCS is a medium close shot",
        "MCS is often written for a cowboy shot (down to the thigh), but means a medium close shot (down to the "
        "breast pocket). It is taken as a medium close-up.",
        "(anna walk) / (static MCS eye-level)",
        "(anna walk) / (static medium-close-up eye-level)",
    ),
    "VDS045": Code(
        "nobody to follow",
        "A camera line alone is an establishing shot: nobody acts in it, so there is no one to follow. Directly "
        "below a story line, without a blank line between, it is another camera on that line.",
        "\n/ (follow wide eye-level)",
        "\n/ (pan wide eye-level)",
    ),
    "VDS046": Code(
        "not a word of the paper",
        "With `rig paper` cameras stand where the paper's printed numbers put them, and it prints none for the "
        "further sizes, angles and movements. The suggestion is the nearest word that it has.",
        "rig paper\n\n(anna walk) / (static cowboy eye-level)",
        "rig paper\n\n(anna walk) / (static medium eye-level)",
    ),
    "VDS047": Code(
        "somebody is missing in the view",
        "`ots NAME` looks over somebody's shoulder at the focus, `pov NAME` through somebody's eyes, a `two-shot` "
        "shows two. Unless said, it is the two of the line: over the shoulder of the one who is acted on at the "
        "one who acts, through the eyes of the one who acts.",
        "(anna wave) / (static medium ots)",
        "(anna wave) / (static medium ots ben)",
    ),
    "VDS049": Code(
        "movements that do not go together",
        "Two movements joined by `+` go on at once: a push and a pan, an arc and a crane. Two of one kind would be "
        "one movement, and a whip pan is over too soon for another.",
        "(anna walk) / (push+pull medium eye-level)",
        "(anna walk) / (push+pan-left medium eye-level)",
    ),
    "VDS048": Code(
        "not through somebody's eyes",
        "A point of view stands where the eyes are and looks where they look: it is static or follows, and its "
        "angle is what it is.",
        "(anna look at ben) / (arc medium pov)",
        "(anna look at ben) / (follow medium pov)",
    ),
    # -- options -----------------------------------------------------------------------------
    "VDS050": Code(
        "unknown option",
        "Options after a line are separated by commas: lens 50mm, ease slow-in, 4s, roll 12deg, aperture 2.8, "
        "focus NAME, "
        'name NAME, feeling glad, say "…", note "…", proposals 80, takes 5, speed brisk, style ink.',
        "(anna walk) lense 50mm",
        "(anna walk) lens 50mm",
    ),
    "VDS051": Code(
        "option said twice",
        "Each option is said once on a line.",
        "(anna walk) lens 50mm, lens 35mm",
        "(anna walk) lens 35..50mm",
    ),
    "VDS052": Code(
        "an option takes one value",
        "The value is missing, or there is one too many; often a comma is.",
        "(anna walk) lens 50mm ease slow-in",
        "(anna walk) lens 50mm, ease slow-in",
    ),
    "VDS053": Code(
        "the wrong unit",
        "A lens is measured in mm, a time in s or f (frames), an angle in deg.",
        "(anna walk) lens 5cm",
        "(anna walk) lens 50mm",
    ),
    "VDS054": Code(
        "out of range",
        "The value is smaller or larger than can be: a lens has 8mm to 400mm, a shot lasts up to two minutes, a "
        "camera rolls up to 90deg.",
        "(anna walk) lens 0mm",
        "(anna walk) lens 24mm",
    ),
    "VDS055": Code(
        "the wrong kind of value for this option",
        "The option takes a text in quotes, a name, a number or a word; the message has an example.",
        "(anna wave) say hello",
        '(anna wave) say "hello"',
    ),
    "VDS056": Code(
        "unknown word for this option",
        "ease is slow-in, slow-out or linear; speed is slow, calm, normal, brisk, fast or a factor; style is board, "
        "clay or ink.",
        "(anna walk) ease slowly",
        "(anna walk) ease slow-in",
    ),
    # -- names -------------------------------------------------------------------------------
    "VDS060": Code(
        "unknown name",
        "Names of things and places are looked for inside the scene first, then in the rest of the set. Parts are "
        "reached with dots, as in chair_2.seat.",
        "(anna walk conter)",
        "(anna walk counter)",
    ),
    "VDS061": Code(
        "ambiguous name",
        "Several things in the set have this name, none of them nearer than the others. Say which, by as much of "
        "its path as it takes. Where a story line means one of several that are alike and all in the scene, the first "
        "is taken, and this is a warning.",
        "(anna walk lamp)",
        "(anna walk living.lamp)",
    ),
    "VDS062": Code(
        "unknown set or room",
        "A scene is a set of the library or of your own, or a room of one, named with a dot.",
        "scene k2 = apartment.kitchn",
        "scene k2 = apartment.kitchen",
    ),
    "VDS063": Code(
        "a scene is missing or wrongly said",
        "What happens, happens in a scene: `scene NAME = SET.ROOM at TIME`. The time of day is dawn, day, dusk or "
        "night.",
        "scene k2 = apartment.kitchen at noon",
        "scene k2 = apartment.kitchen at day",
    ),
    "VDS064": Code(
        "unknown cast",
        "A character is one of the cast in the library or one defined in the script, dressed by its parameters.",
        "character carla = womman",
        "character carla = woman",
    ),
    "VDS065": Code(
        "unknown character",
        "Who takes part has a `character` line before.",
        "(anja walk)",
        "(anna walk)",
    ),
    "VDS066": Code(
        "character defined twice",
        "A name stands for one character through the whole storyboard.",
        "character anna = man",
        "character anton = man",
    ),
    "VDS067": Code(
        "impossible height",
        "People are 0.7m to 2.4m tall.",
        "character carla = woman(height 17m)",
        "character carla = woman(height 1.7m)",
    ),
    "VDS068": Code(
        "placed twice",
        "In a scene everyone is placed once, before they do anything; after that they walk.",
        "anna at counter",
        "(anna walk counter)",
    ),
    "VDS069": Code(
        "no seat here",
        "One sits on what has a seat, one person on each: a chair, a sofa, a bench, or a spot called seat; or at a "
        "table to which seats are drawn up.",
        "carl at door sitting",
        "carl at chair_1 sitting",
    ),
    # -- what happens ------------------------------------------------------------------------
    "VDS070": Code(
        "nothing is done",
        "Between the parentheses stand a character, an action and what it is done to.",
        "(anna)",
        "(anna wave)",
    ),
    "VDS071": Code(
        "unknown action",
        "Actions are those of the library and those defined in the script, by their names or by other words for them "
        "(take for pick up), as they are called or in the third person (walks). An action of two words may be written "
        "with a space: pick up.",
        "(anna wlk counter)",
        "(anna walk counter)",
    ),
    "VDS072": Code(
        "a target is missing",
        "The action is done to something or someone, or at a place, and that is not said.",
        "(anna pick up)",
        "(anna pick up cup)",
    ),
    "VDS073": Code(
        "a target too many",
        "An action has no, one or two targets. A second one follows a word like to, at, with, from, in, into, on, onto.",
        "(anna pour cup table)",
        "(anna pour cup)",
    ),
    "VDS074": Code(
        "an action for something else",
        "The action is not done to this kind of target: one greets people and picks up things.",
        "(anna greet cup)",
        "(anna greet ben)",
    ),
    "VDS075": Code(
        "done to oneself",
        "Someone is the target of their own action.",
        "(anna greet anna)",
        "(anna greet ben)",
    ),
    "VDS076": Code(
        "two things at once",
        "Actions joined by `+` run at the same time, so each is someone else's.",
        "(anna walk) + (anna wave)",
        "(anna walk) + (ben wave)",
    ),
    "VDS077": Code(
        "someone who is not in the scene",
        "The camera can only be on, and people can only face, who is in the scene: who is placed in it, or does "
        "something in it. And they can only be placed by somebody whom a line above places.",
        "(anna walk) focus carl",
        "carl at counter\n(anna walk) focus carl",
    ),
    "VDS078": Code(
        "transition without two sides",
        "A transition stands between two story lines and joins them in one way. A film may begin with a fade-in and "
        "end with a fade-out, and a fade-in may follow a fade-out.",
        "(anna wave)\ndissolve 12f\nwipe\n(anna walk)",
        "(anna wave)\ndissolve 12f\n(anna walk)",
    ),
    "VDS080": Code(
        "empty hands",
        "The action is done with something that should be in a hand by now, and nobody picked it up. The line is "
        "played all the same, as well as that can be.",
        "(ben put down)",
        "(ben pick up cup)\n(ben put down)",
    ),
    "VDS081": Code(
        "nothing to hold",
        "Who is placed `holding` something has it in a hand when the scene opens: a thing of the scene, or any prop that "
        "can be carried.",
        "carl at counter holding sofa",
        "carl at counter holding cup",
    ),
    "VDS082": Code(
        "a word that does not show",
        "A thing looks as it is defined. Words before its name that are no part of it say nothing to a picture, and "
        "are left out; so are clauses of a sentence that say why, when or like what, and where something is done "
        "that takes no such place.",
        "(anna walk old table)",
        "(anna walk table)",
    ),
    "VDS083": Code(
        "a thing that is not in the scene",
        "What is done is done to a thing that the set has not, but the library has. One is put near who does it, on "
        "something or on the floor, from the beginning of the scene on.",
        "scene two = street\n(carl pick up cup)",
        "scene two = street\ncarl at bench holding cup\n(carl wave)",
    ),
    "VDS084": Code(
        "a box stands in for something",
        "What is done is done to a thing that neither the set nor the library has. A plain box lies near who does it "
        "in its place, from the beginning of the scene on, so that the line can be filmed; a prop of that name in the "
        "script says what the thing looks like.",
        "(carl picks up the harp)",
        "(carl picks up the cup)",
    ),
    "VDS085": Code(
        "something else is shown",
        "A sentence cannot be acted as it is written: no action is called so, or it is done to something else, or what "
        "it is done to is not there. So that the story can be filmed all the same, as much of it is shown as can be: "
        "the action alone, or who it is about looks at what it names, or waits. The boards have the words as they are "
        "written. A line in the short form, as `(carl walk counter)`, has to be right.",
        "(carl yodels)",
        "(carl waves)",
    ),
    "VDS079": Code(
        "someone has no place yet",
        "Someone takes part in a scene and has not been placed in it. They are put at the scene's first free spot; "
        "a placement says where they should be.",
        "(carl walk)",
        "carl at counter\n(carl walk)",
    ),
    # -- sets and props -------------------------------------------------------------------
    "VDS100": Code(
        "unknown colour",
        "A colour is one of the words (sage, crimson, oak …) or a text with three or six hexadecimal "
        "digits. Every word is listed in docs/sets.md.",
        "box (1, 1, 1)m, color crimsn",
        "box (1, 1, 1)m, color crimson",
    ),
    "VDS101": Code(
        "a size of zero or less",
        "A solid has an extent in every direction, a room has a floor, an opening has a width. Sizes "
        "may be computed; what comes out must be above zero with the defaults of the definition.",
        "box (40cm, 0, 4cm)",
        "box (40cm, 40cm, 4cm)",
    ),
    "VDS102": Code(
        "repeat without a number of times",
        "`repeat NAME COUNT { … }` writes its entries COUNT times, with NAME = 0, 1, 2 … in their "
        "expressions. COUNT is a whole number up to 200.",
        "repeat i 2.5 { … }",
        "repeat i 3 { … }",
    ),
    "VDS103": Code(
        "too few points",
        "A lathe turns a profile of at least two (radius, z) points, an extrusion raises an outline of "
        "at least three (x, y) points, and a tube follows a path of at least two (x, y, z) points.",
        "extrude, outline ((0, 0), (1, 0))m, height 1m",
        "extrude, outline ((0, 0), (1, 0), (0, 1))m, height 1m",
    ),
    "VDS104": Code(
        "not a direction",
        "`along` says where the shape's own upward axis points: along one of the axes, forwards or "
        "backwards.",
        "cylinder 2cm, height 1m, along up",
        "cylinder 2cm, height 1m, along -y",
    ),
    "VDS110": Code(
        "a set has no parameters",
        "Props and cast members are made to measure where they are used; a set is one place. Write a "
        "second set, or place other props.",
        "set kitchen(width 4m) { … }",
        "set kitchen { … }",
    ),
    "VDS111": Code(
        "a set of nothing",
        "A set is made of rooms (with walls) and areas (outdoors); it needs one at least.",
        "set yard { }",
        "set yard {\n    area lawn, size (12, 8)m\n}",
    ),
    "VDS112": Code(
        "a name taken twice",
        "Names in one room, and names of what stands on one thing, are different from each other, so "
        "that a story can tell which is meant.",
        "place chair = chair, at (1, 1)m\nplace chair = chair, at (2, 1)m",
        "place chair_1 = chair, at (1, 1)m\nplace chair_2 = chair, at (2, 1)m",
    ),
    "VDS113": Code(
        "an opening outside its wall",
        "`at` is the middle of a door or window, measured along the wall from its west or south end. "
        "The whole opening must lie within the wall, and below its top.",
        "door, wall north, at 0.2m",
        "door, wall north, at 0.8m",
    ),
    "VDS114": Code(
        "a door to nowhere",
        "`to` names the room behind a door. That room has to share the stretch of wall the door is in.",
        "door, wall east, at 1m, to bathroom",
        "door, wall east, at 1m, to living",
    ),
    "VDS115": Code(
        "unknown prop",
        "Props are those of the library and those defined in the script. docs/library/props.md lists the library's.",
        "place lamp = flor_lamp, at (1, 1)m",
        "place lamp = floor_lamp, at (1, 1)m",
    ),
    "VDS116": Code(
        "nothing to stand it on",
        "`on NAME` puts a thing on a spot of the prop it stands in the braces of: one the prop's "
        "definition gives it, such as `top`, or one said in the braces.",
        "place chair = chair, at (1, 1)m { place cup = cup, on top }",
        "place table = table, at (1, 1)m { place cup = cup, on top }",
    ),
    # -- actions -------------------------------------------------------------------------
    "VDS140": Code(
        "an action has no parameters",
        "Props and cast members are made to measure; an action is done in ways. Each way is a `variant`, with its "
        "own amplitude, tempo or poses, and the ranking chooses between them.",
        "action hop(height 20cm) {\n    duration 1s\n}",
        "action hop {\n    duration 1s\n    at 50% { hips drop -10cm }\n    variant high { amplitude 150% }\n}",
    ),
    "VDS141": Code(
        "an action without a duration",
        "Poses and reaches are placed in time, as shares of the action's duration, so it has to be said. Only an "
        "action that does nothing but travel has none.",
        "action hop {\n    at 50% { hips drop -10cm }\n}",
        "action hop {\n    duration 1s\n    at 50% { hips drop -10cm }\n}",
    ),
    "VDS142": Code(
        "a time that is neither a share nor seconds",
        "A time inside an action is a share of its duration, `30%`, or seconds from its start, `0.8s`.",
        "action hop {\n    duration 1s\n    at 0.5 { hips drop -10cm }\n}",
        "action hop {\n    duration 1s\n    at 50% { hips drop -10cm }\n}",
    ),
    "VDS143": Code(
        "a time outside the action",
        "An action goes from 0% to 100% of its duration.",
        "action hop {\n    duration 1s\n    at 1.5s { hips drop -10cm }\n}",
        "action hop {\n    duration 2s\n    at 1.5s { hips drop -10cm }\n}",
    ),
    "VDS144": Code(
        "times that do not follow one another",
        "A reach leaves `from`, is there `at`, stays `until` and is `back`, in this order; other spans go `from` a "
        "time `to` a later one.",
        "action tap {\n    duration 1s\n    reach right chest, from 50%, at 30%\n}",
        "action tap {\n    duration 1s\n    reach right chest, from 30%, at 50%\n}",
    ),
    "VDS145": Code(
        "nothing to bring",
        "An action `brings` a prop that can be carried, for what it `needs` in a hand and the line does not name: its "
        "target or its second.",
        "action hum {\n    duration 1s\n    brings flute\n}",
        "action hum {\n    target optional object\n    needs target\n    duration 1s\n    brings flute\n}",
    ),
    # -- the cast (VDS160-169) -----------------------------------------------------------
    "VDS160": Code(
        "unknown feature of a person",
        "A cast definition sets features: height, build, body, age, skin, eyes, hair, hair-color, facial-hair, "
        "glasses, hat, hat-color, neck, top, top-kind, shirt, over, bottom, bottom-kind, belt, back, gloves, badge, "
        "accent, shoes and shoes-kind. Nothing else is known of people.",
    ),
    "VDS161": Code(
        "a feature of the wrong size or kind",
        "Height is a length from 0.7m to 2.4m; build and body go from 0 to 1 or are words; age is in years from 3 to "
        "110 or a word. All other features are words.",
    ),
    # -- playing the scene (VDS170-179) ----------------------------------------------------
    "VDS170": Code(
        "a target that cannot be reached",
        "People walk on the floor, around what stands on it and around each other, and need half a metre of room "
        "to pass. Nothing of that kind leads to this target. The message says what stands in the way, and what can "
        "be reached from there instead.",
    ),
    "VDS171": Code(
        "no seat here",
        "One sits on things that have a `seat` spot, one person on each: chairs, sofas, beds, benches.",
    ),
    "VDS172": Code(
        "no room to stand here",
        "To be placed at something there must be free floor beside it: a circle of half a metre.",
    ),
    "VDS173": Code(
        "nothing to lean against",
        "To lean against something one stands before it with one's back to it, so it has to be upright and fixed, as a wall, "
        "a tree or a counter, with free floor before it. Where no name is given it is the nearest wall.",
    ),
    "VDS260": Code(
        "two manners",
        "A person does one thing in one manner: `briskly` or `sadly`, not both.",
        "(anna walk briskly sadly door)",
        "(anna walk briskly door)",
    ),
    "VDS261": Code(
        "whose feeling?",
        "On an establishing shot nobody acts, so a feeling there has to say whose it is.",
        "/ (wide) feeling sad",
        "/ (wide) feeling anna sad",
    ),
    # -- filming it (VDS190-199) -------------------------------------------------------------
    "VDS190": Code(
        "no camera could film this",
        "Every proposed camera stood in a wall or a thing, did not see its subject, or did not keep to the words of "
        "its line. The message says what is in the way and counts why; the shot is left out of the build. What the "
        "help names has been tried: there is a camera for each.",
    ),
    "VDS191": Code(
        "nothing to film",
        "A file that only defines sets, props, cast or actions can be checked, but there is no story in it to make "
        "a film of.",
    ),
    "VDS192": Code(
        "no camera does quite what this says",
        "Cameras have room, but none keeps to all the words of its line and sees its subject well. The least bad ones "
        "are offered. What the help names has been tried: there is a good camera for each.",
    ),
    "VDS193": Code(
        "no take without a fault",
        "Cameras do what the line says, but film grammar finds a fault in every one of them; those with the least of it "
        "come first. The message says what most of them have; what the help names has been tried: there is a camera "
        "without a fault for each.",
    ),
    # -- cutting shots together (VDS280-289) ---------------------------------------------------
    "VDS280": Code(
        "a cut crosses the line",
        "Two people who have to do with each other have a line between them, and somebody who goes somewhere has "
        "one along the way. As long as all cameras stay on one side of it, left stays left and right stays right. "
        "A cut to the other side puts everybody where the other one was. The degrees say how far beyond the line "
        "the second camera stands; cameras within ten degrees of it take no side.\n\n"
        "`vdsc compile --edit` chooses takes from one side where there are any.",
    ),
    "VDS281": Code(
        "a cut turns the screen direction",
        "Somebody who leaves one picture going to the right and goes on the same way in the next one should still "
        "go to the right; otherwise they seem to have turned round.",
    ),
    "VDS282": Code(
        "a cut breaks the eyeline",
        "When two people who look at each other are shown one after the other, one looks to the right and the other "
        "to the left. Where both look the same way, they seem to look at somebody else.",
    ),
    "VDS283": Code(
        "a jump cut",
        "The same subject twice in a row, from nearly the same side and nearly as large, seems to jump rather than "
        "to be seen anew. Another view is at least thirty degrees aside, or a size closer or farther away.",
        "(anna walk door) / (static medium eye-level)\n(anna wave) / (static medium eye-level)",
        "(anna walk door) / (static full eye-level)\n(anna wave) / (static medium eye-level)",
    ),
    "VDS284": Code(
        "a leap in size",
        "From very wide to very close on the same subject in one cut is strong. That may be meant; otherwise a size "
        "between the two leads the eye.",
        "/ (static wide eye-level) focus anna\n(anna wave) / (static extreme-close-up eye-level)",
        "/ (static wide eye-level) focus anna\n(anna wave) / (static medium eye-level)",
    ),
    # -- choices and projects (VDS310-319) -----------------------------------------------------
    "VDS310": Code(
        "this lock does not read",
        "`FILE.lock` holds the takes that were chosen, one line a shot. A line in it is not as `vdsc pick` writes it, "
        "or two versions of the file were left unmerged. Nothing is compiled and nothing is written over, so that no "
        "choice is lost.\n\n"
        "Where two people chose, keep for every shot the line that is wanted. Their order does not matter, nor do "
        "comments, which begin with `#`.",
    ),
    "VDS311": Code(
        "a chosen take no longer exists",
        "A choice names a take by how it is acted and filmed. When its line changes, or a line before it that leaves "
        "people or things elsewhere, other takes are proposed, and the one that was chosen may be none of them. The "
        "best of the new ones is shown instead. The choice stays in the lock: it holds again when the line is as it "
        "was.",
    ),
    "VDS312": Code(
        "a choice for a shot that is gone",
        "The lock has a choice for a shot that is not in the script: its line was removed, or says something else "
        "now. The choice stays in the lock until it is taken back.",
    ),
    "VDS314": Code(
        "two shots of one name",
        "A name is a shot's id: its takes are kept under it, and choices hang on it.",
        "(anna wave) / (static medium) name hello\n(ben wave) / (static medium) name hello",
        "(anna wave) / (static medium) name hello\n(ben wave) / (static medium) name answer",
    ),
    "VDS313": Code(
        "this project file does not read",
        "`vds.toml` holds settings for all the scripts beside it and below. A setting in it is not known, or its "
        "value is none that the setting can have. `docs/watch.md` lists them.",
    ),
    # -- what opens, and floors at heights (VDS240-259) --------------------------------------
    "VDS240": Code(
        "a part that does not move",
        "A `hinge` has in its braces the shapes that turn, and an angle `open`; a `slide` a length `open`.",
        "hinge lid, at (0, 15cm, 20cm), axis x, open 0deg { box (40cm, 30cm, 2cm) }",
        "hinge lid, at (0, 15cm, 20cm), axis x, open -100deg { box (40cm, 30cm, 2cm), at (0, 0, 20cm) }",
    ),
    "VDS241": Code(
        "stairs to nowhere",
        "Stairs climb from where they stand to the floor of the room `to`, or by a `height`, in steps of no more "
        "than 0.4 m. The `steps` of a platform are on its sides: north, south, east or west.",
        "stairs, at (1, 0.5)m, to cellar",
        "stairs, at (1, 0.5)m, to landing",
    ),
    "VDS242": Code(
        "nothing opens here",
        "What opens has a part with a `hinge` or a `slide`: doors, cupboards, drawers, lids. The message lists what "
        "opens in the scene. The hands move, but nothing opens.",
        "(anna open table)",
        "(anna open fridge)",
    ),
    "VDS243": Code(
        "open or closed already",
        "What was opened stays open, in the next scene line too, until somebody closes it.",
        "(anna open fridge)\n(anna open fridge)",
        "(anna open fridge)\n(anna close fridge)",
    ),
    # -- files of other programs (VDS200-219) ------------------------------------------------
    "VDS200": Code(
        "no such file to import",
        "The file a definition names is missing, or is of a kind nothing of that sort comes out of. Things and sets "
        "come out of .glb, .gltf, .obj, .ply and .stl, people out of .glb and .gltf, actions out of .bvh, .glb and "
        ".gltf. The path is relative to the file it is written in.",
        'prop lamp_a = "lamp.blend"',
        'prop lamp_a = "lamp.glb", height 40cm',
    ),
    "VDS201": Code(
        "file that cannot be used",
        "The file is there, but broken (cut off, numbers that are none, references to what is not there), larger than "
        "what can be filmed, or it wants files from outside the project's folder. The message says which. `docs/import.md` "
        "has the limits.",
    ),
    "VDS202": Code(
        "options of a file that do not go together",
        "Of `height`, `length`, `width` and `scale` one is enough: a model keeps its proportions. A stretch of a motion "
        "goes `from` an earlier `to` a later time.",
        'prop lamp_a = "lamp.glb", height 40cm, scale 1cm',
        'prop lamp_a = "lamp.glb", height 40cm',
    ),
    "VDS203": Code(
        "nobody in this file",
        "A character out of a file needs a skeleton with a skin on it, so that it can move: a hips bone with two legs, "
        "a spine and two arms.",
        'cast robot_a = "lamp.glb"',
        'prop robot_a = "lamp.glb"',
    ),
    "VDS204": Code(
        "no such motion in this file",
        "An action out of a file is one motion of it: the first, or the one named with `clip`.",
        'action wave_a = "robot.glb", clip "Wavee"',
        'action wave_a = "robot.glb", clip "Wave"',
    ),
    # -- focus -------------------------------------------------------------------------------
    "VDS300": Code(
        "only a rack-focus takes the focus elsewhere",
        "`focus anna to ben` says where the focus goes while the camera runs. That is a movement, which the camera "
        "has to be told: `rack-focus`, alone or with another (`push+rack-focus`).",
        "(anna wave) / (static medium eye-level) focus anna to ben",
        "(anna wave) / (rack-focus medium eye-level) focus anna to ben",
    ),
    "VDS301": Code(
        "a rack-focus needs two that are apart",
        "The focus goes from whom the camera is about to somebody or something else: the other one of the line, "
        "unless `focus anna to ben` says whom.",
        "(anna wave) / (rack-focus medium eye-level)",
        "(anna wave) / (rack-focus medium eye-level) focus anna to ben",
    ),
    # -- pictures with words on them (VDS330-339) ----------------------------------------------
    "VDS330": Code(
        "letters that no typeface here has",
        "Sheets, plans and burn-ins are written in a typeface that comes with the program; it has Latin, Greek and "
        "Cyrillic. For other scripts a typeface of this machine is taken. Where there is none, empty boxes are "
        "drawn; films, tracks and the page are not touched by that.",
    ),
}


def title(code: str) -> str:
    """The title of a code; a code nobody described is its own title."""
    return CODES[code].title if code in CODES else code
