"""The take JSONs of a film with ``rig paper`` hold what the paper's equations say."""

import json
from pathlib import Path

import numpy as np
from paper_equations import recomputed

import vdsl

STORY = """\
storyboard "Paper"
fps 24
size 64x36
proposals 24
takes 8
rig paper

character anna = woman

scene yard = suburb_street
anna at mailbox

(anna walk bus_stop)
    / (follow full eye-level)
    / (push medium high-angle)
    / (static close-up low-angle)
    / (arc full high-angle)
    / (zoom medium eye-level)
    / (tilt full eye-level)
    / (pan medium eye-level)
    / (dolly full eye-level)
    / (pedestal full eye-level)
"""


def test_tracks_on_disk_equal_the_equations_of_their_params(tmp_path: Path) -> None:
    (tmp_path / "story.vds").write_text(STORY)
    vdsl.compile(tmp_path / "story.vds", tmp_path / "out", rank="geometry", device="cpu")
    families = set()
    for path in sorted((tmp_path / "out" / "shots").rglob("take-*.json")):
        take = json.loads(path.read_text())
        assert take["rig"] == "paper"
        positions = np.array(take["subject"]["position"])
        position, rotation, focal = recomputed(take["movement"], take["params"], positions)
        np.testing.assert_allclose(take["camera"]["position"], position, atol=1e-6, err_msg=str(path))
        np.testing.assert_allclose(take["camera"]["focal_mm"], focal, atol=1e-6)
        turned = np.deg2rad(take["camera"]["rotation_deg"]) - rotation
        np.testing.assert_allclose(turned - 2 * np.pi * np.round(turned / (2 * np.pi)), 0.0, atol=1e-6)
        families.add(take["movement"].split("-")[0])
    assert len(families) >= 8
