# SPDX-License-Identifier: GPL-3.0-or-later
"""VOTCA's files: maps in XML, settings that become a run file."""

import pytest

import mesofit

MAP = """<cg_molecule><name>{0}</name><topology><cg_beads><cg_bead><name>b</name><type>{0}</type>
<mapping>m</mapping><beads>1:{0}:O 1:{0}:H</beads></cg_bead></cg_beads></topology>
<maps><map><name>m</name><weights>15.999 1.008</weights></map></maps></cg_molecule>"""

SETTINGS = """<cg><non-bonded><name>A-A</name><type1>A</type1><type2>A</type2><max>0.9</max>
<inverse><target>A-A.dist.tgt</target></inverse></non-bonded>
<inverse><kBT>2.49435</kBT></inverse></cg>"""


def test_maps_in_xml_are_maps(tmp_path):
    atoms = [(residue, name) for residue in range(40) for name in "OH"]
    lines = [f"{residue + 1:5d}{'AB'[residue % 2]:<5s}{name:>5s}{k + 1:5d}"
             f"{residue * 0.7 % 3:8.3f}{residue * 0.9 % 3:8.3f}{k * 0.05 % 3:8.3f}"
             for k, (residue, name) in enumerate(atoms)]
    (tmp_path / "conf.gro").write_text("\n".join(["", str(len(atoms)), *lines, "3 3 3", ""]))
    for name in "AB":
        (tmp_path / f"{name}.xml").write_text(MAP.format(name))
    ours = mesofit.measure(tmp_path / "conf.gro", static=True, temperature=300, progress=False)
    theirs = mesofit.measure(tmp_path / "conf.gro", static=True, temperature=300, progress=False,
                             map=[tmp_path / "A.xml", tmp_path / "B.xml"])
    assert (theirs.table("rdf_A-B")["g"] == ours.table("rdf_A-B")["g"]).all()


def test_settings_become_a_run_file(tmp_path):
    (tmp_path / "settings.xml").write_text(SETTINGS)
    (tmp_path / "A-A.dist.tgt").write_text(
        "".join(f"{0.01 * k} {float(k > 30)} i\n" for k in range(101)))
    with pytest.raises(mesofit.InputError, match="give it by box"):
        mesofit.import_votca(tmp_path / "settings.xml", tmp_path / "run")
    run = mesofit.import_votca(tmp_path / "settings.xml", tmp_path / "run", box=4,
                               count={"A": 900}, progress=False)
    assert '"count":\t900' in run.read_text()
    assert (tmp_path / "run" / "A-A.dist.tgt").exists()
