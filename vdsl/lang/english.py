"""English verbs as they are said: common ones that are no slips of others, and the past of irregular ones.

A verb that nobody can act here is no slip of one that somebody can: ``hates`` is not ``chats``.
"""

from __future__ import annotations

#: Common verbs, in the form that actions have.
VERBS = frozenset(
    """
    accept ache act add admire admit adopt adore advise agree aid allow amaze amuse annoy appear apply
    arrange assume attach attack attempt avoid award back bake balance bang bark bathe battle bear beat
    become beep believe belong bend bet bind blame blast bleed bless blind blink bloom blow boil bolt
    bomb book bore borrow bother bounce brag brake brave break breathe bring bubble build bump burn
    burst bury buy calm can care carve cast cause challenge change charge chase chat cheat chew chill
    choke choose chug circle claim clear click climb cling clog clutch coach coil collapse collect comb
    come command compare compete complain complete confess confuse connect contain control cost crack
    crash crave creak create creep cringe cross crouch crow crumble crumple crush curl curse dangle dare
    dash date deal decide decorate defend delay deliver demand deny depart describe deserve design
    destroy detect develop die dim dip disagree disappear discover discuss dislike dive divide dodge
    doubt drag drain dread dream dress dribble drift drip drown drum dry dump dunk earn echo edit
    embarrass empty encourage end enjoy escape examine excite excuse exist expand expect explode explore
    express extend face fade fail fancy fasten fear feel fetch fiddle file fill film find finish fire
    fit flap flare flash flee flick flicker flinch flip float flood flop flow fly fold forbid force
    forget forgive form frame free freeze frighten fry fumble gain gamble gather gaze get glow glue grab
    grate grin grind groan grow guard guess guide hammer hang happen hate haunt have head heal heap hear
    heat hesitate hint hire hit hold hope hover howl hum hunt hurt ignore imagine impress improve
    increase inform insist intend invent invite itch jail jam jingle join joke joust judge juggle keep
    kick kidnap kill knit know lack land last launch lay lead leak learn lend let lick lie like line
    linger link listen live load lock long loom loosen lose love lower lurk make manage marinate mark
    marry match matter mean melt mend mess milk mind miss mix moan move mow mug mumble murder mutter nag
    nail name need nest nip nod note notice nurse obey observe obtain offend open order owe own pack
    paddle park part pass pause pedal peel peep perform pick pin pinch pity place plan plant play plead
    please plot plug poke pop pose possess post pour pout practise praise pray preach prefer prepare
    press pretend prick print produce promise protect prove provide pull pump punish push put question
    quit race rain raise rake reach realise realize receive recognise recognize recover reduce reflect
    refuse regret reject relax release rely remain remember remind remove repair repeat replace reply
    report request rescue rest return reveal reverse rhyme rid ride ring rinse rip rise risk roar rob
    rock roll rot row rub ruin rule rush sack sail save say scare scatter scold scorch score scrape
    scratch scribble scroll see seem select sell send separate serve set settle shade shape share
    shatter shave shed shelter shift shine shiver shock shoot shop show shrink shut sign sink sip skate
    sketch skid skip slam slap slice slide slip slow smash smell smoke snap snatch sneer snow soak solve
    soothe sort sound sow spare spark sparkle speed spell spend spill spin splash split spoil spray
    spread spring sprout squash squeak squeal squeeze squint stack stain stamp star start starve stay
    steal steam steer step stick sting stitch stop store strap strip stroke struggle stuff stumble
    subtract succeed suck suffer suggest suit supply support suppose surprise surround suspect swallow
    swap sway swear sweat swell swim swing switch tame tap taste tear tease telephone tempt test thaw
    think thump tick tickle tie tighten time tip tire tour tow trace trade train trap travel treat trip
    trot trouble trust try tuck tug tumble twist twitch type unpack untie use vanish vibrate visit wail
    walk wander want warm warn wash waste wave weave weep weigh welcome wheel whine whip whirl whisk
    whistle win wind wipe wish wobble wonder work worry worsen worship wrap wreck wrestle wriggle yell
    yodel zip zoom
    """.split()  # noqa: SIM905 (a list of hundreds of quoted words reads worse)
)

#: Irregular pasts, but for those that are something else as well (``saw``, ``rose``, ``ground``).
PAST = {
    "ate": "eat", "began": "begin", "bent": "bend", "blew": "blow", "broke": "break", "brought":
    "bring", "came": "come", "caught": "catch", "chose": "choose", "crept": "creep", "drank": "drink",
    "drew": "draw", "drove": "drive", "dug": "dig", "fed": "feed", "fell": "fall", "felt": "feel",
    "fled": "flee", "flew": "fly", "fought": "fight", "found": "find", "froze": "freeze", "gave":
    "give", "got": "get", "heard": "hear", "held": "hold", "hid": "hide", "hung": "hang", "kept":
    "keep", "knelt": "kneel", "lay": "lie", "leapt": "leap", "left": "leave", "lit": "light", "lost":
    "lose", "made": "make", "met": "meet", "paid": "pay", "ran": "run", "rang": "ring", "said": "say",
    "sang":     "sing", "sank": "sink", "sat": "sit", "sent": "send", "shook": "shake", "showed":
    "show", "slept": "sleep", "slid":     "slide", "spat": "spit", "spoke": "speak", "spun": "spin",
    "stole": "steal", "stood": "stand", "struck": "strike", "swam": "swim", "swept": "sweep", "swung":
    "swing", "taught": "teach", "thought": "think", "threw":     "throw", "told": "tell", "took":
    "take", "tore": "tear", "went": "go", "wept": "weep", "woke":     "wake", "wore": "wear", "wrote":
    "write",
}  # fmt: skip

#: What is not done does not show.
NOT = ("not", "never")
#: Verbs that go before others, or say only that something is.
MODALS = (
    "can", "cannot", "could", "will", "would", "should", "shall", "may", "might", "must", "did", "do", "does",
    "has", "had", "have", "is", "are", "was", "were",
)  # fmt: skip


def is_past(word: str) -> bool:
    """Whether a word is a past, or a participle: ``kissed``, ``stolen``."""
    return (
        word.endswith("ed")
        or word in PAST
        or word in ("bitten", "beaten", "given", "stolen", "taken", "thrown")
    )


def is_not(word: str) -> bool:
    """Whether a word says that something is not done: ``not``, ``doesn't``."""
    return word in NOT or word.endswith(("n't", "n’t")) or word == "cannot"
