"""A script's only line, staged and proposed, for the tests of what is seen of it."""

from __future__ import annotations

from vdsl.lang import Source
from vdsl.pipeline.acts import Act, stage_acts
from vdsl.pipeline.script import check_source
from vdsl.propose.story import propose
from vdsl.propose.types import ProposalGrid


def proposed(text: str) -> tuple[Act, ProposalGrid]:
    (act,) = stage_acts(check_source(Source("seen.vds", text)))
    return act, propose(act.line, act.line.shots[0], act.state, act.filming)
