"""Analyses, barriers, comparisons, sweeps, docking: as the program has them."""

import json
import pathlib
import pickle
import re
import subprocess

import numpy as np
import pandas
import pytest
import tilebind
from conftest import SMALL


def test_tables_are_for_pandas(analysis):
    states = pandas.DataFrame(analysis.states)
    assert states.kind[0] == "bound" and states.name[0] == "A"
    assert states.energy_J[0] == states.energy_J.min() == pytest.approx(analysis.bound_energy, rel=1e-6)
    assert {"x_m", "y_m", "theta_rad", "escape_J", "escape_to", "caged", "capture_share"} <= set(states)
    barriers = pandas.DataFrame(analysis.barriers)
    assert "pathway" not in barriers and barriers["from"].dtype == np.int64
    assert (barriers.saddle_energy_J >= states.energy_J.min()).all()
    with pytest.raises(ValueError):
        analysis.states["id"] = 0


def test_pathways_lead_from_place_to_place(analysis):
    barrier = analysis.barriers[0]
    path = analysis.pathway(barrier["from"], barrier["to"])
    assert path["energy_J"].max() == barrier["saddle_energy_J"]
    assert path["clearance_m"].min() > -1e-6 and np.all(np.diff(path["s_m"]) >= 0)
    back = analysis.pathway(barrier["to"], barrier["from"])
    assert np.array_equal(back["energy_J"], path["energy_J"][::-1])
    assert np.array_equal(analysis.pathway("A"), analysis.pathway(0, "free"))
    for wrong in (999, "Z''", -5):
        with pytest.raises(ValueError):
            analysis.pathway(wrong)
    with pytest.raises(LookupError, match="barrier"):
        analysis.pathway("free", "free")


def test_maps_and_graphs(analysis):
    found = analysis.landscape_map(samples=24, orientations=8)
    assert found.energy.shape == found.theta.shape == (len(found.y), len(found.x))
    free = ~np.isnan(found.energy)
    row, column = np.argwhere(free)[0]
    pose = [found.x[column], found.y[row], found.theta[row, column]]
    assert analysis.design.energy(pose) == pytest.approx(found.energy[row, column], rel=1e-9)
    with pytest.raises(ValueError):
        analysis.landscape_map(samples=1)
    lines = analysis.disconnectivity()
    kinds = set(analysis.states["name"])
    assert kinds <= {name for line in lines for name in line["states"].split()}
    assert analysis.svg("map").startswith("<svg")
    with pytest.raises(ValueError, match="disconnectivity"):
        analysis.svg("graph")
    shown = analysis._repr_html_()
    assert shown.count("<img") == 2 and "&lt;" not in shown[:20]
    assert "results in" not in analysis.summary()


@pytest.mark.parametrize("name", ["tab-20mm", "paper-tile"])
def test_files_are_those_of_the_program(program, root, tmp_path, name):
    file = root / f"shapes/{name}.toml"
    options = [f"--{key.replace('_', '-')}={value}" for key, value in SMALL.items()]
    run = [program, "analyse", str(file), *options, "--quiet"]
    subprocess.run([*run, "--out", str(tmp_path / "program")], check=True)
    told = " ".join(["tilebind analyse", file.name, *options, "--out results"])
    found = tilebind.Design.load(file).analyse(progress=False, **SMALL)
    found.write(tmp_path / "python", command=told)
    theirs, ours = (
        {p.relative_to(tmp_path / k): p.read_bytes() for p in (tmp_path / k).rglob("*") if p.is_file()}
        for k in ("program", "python")
    )
    assert set(theirs) == set(ours)
    report, record = map(pathlib.Path, ["report.json", ".tilebind.json"])
    for path in theirs:
        if path == record:  # It has the checksum of report.json.
            assert json.loads(theirs[path])["files"].keys() == json.loads(ours[path])["files"].keys()
        elif path == report:
            assert without_timing(theirs[path].decode()) == without_timing(ours[path].decode())
        else:
            assert theirs[path] == ours[path], path
    alone = json.loads(found.report_json())
    whole = json.loads(ours[report])
    del whole["timing"], alone["timing"]
    assert alone == whole


def without_timing(text):
    """All bytes but the times."""
    left, count = re.subn(r'"(total_)?wall_s": [0-9.e-]+', "", text)
    assert count > 3
    return left


def test_only_own_files_are_replaced(analysis, tmp_path):
    report = tmp_path / "report.json"
    for mine in ("{}", '{"tilebind": "0.1.0", "files": {}}'):
        report.write_text(mine)
        with pytest.raises(ValueError, match="another folder, or .* with force=True"):
            analysis.write(tmp_path)
        assert [path.name for path in tmp_path.iterdir()] == ["report.json"]
        assert report.read_text() == mine
    analysis.write(tmp_path, force=True)
    analysis.write(tmp_path, compact=True)
    assert not (tmp_path / "report.html").exists()
    report.write_text(report.read_text() + " ")
    with pytest.raises(ValueError, match="report.json was changed since"):
        analysis.write(tmp_path)
    with pytest.raises(ValueError, match="is a file"):
        analysis.write(report)


def test_a_design_file_is_never_replaced(analysis, design, tmp_path):
    file = tmp_path / "report.json"
    file.write_text(design.text)
    own = tilebind.Design.load(file).analyse(progress=False, **SMALL)
    with pytest.raises(ValueError, match="never replaced"):
        own.write(tmp_path, force=True)
    assert file.read_text() == design.text


def test_results_travel(analysis):
    again = pickle.loads(pickle.dumps(analysis))
    assert again.report_json() == analysis.report_json()
    assert again.states.tobytes() == analysis.states.tobytes()
    assert again.report_html() == analysis.report_html()
    assert again.design == analysis.design


def test_a_barrier_between_bounds(design):
    found = design.barrier(design.bound, tolerance=1e-3, milestones=1000, progress=False)
    lower, upper, path, *_ = found
    assert lower <= found.saddle_energy <= upper + 1e-12 and upper - lower <= 1e-3
    assert path["energy_J"].max() == found.saddle_energy
    assert found.forward == found.saddle_energy - design.energy(design.bound)
    assert pickle.loads(pickle.dumps(found)).lower == lower
    with pytest.raises(ValueError, match="overlap"):
        design.barrier([0.0, 0.0, 0.0], progress=False)
    for wrong in ([1, 2], [np.nan, 0, 0], "bound"):
        with pytest.raises(ValueError):
            design.barrier(design.bound, wrong, progress=False)
    with pytest.raises(ValueError, match="tolerance = 0: .*from 1e-30"):
        design.barrier(design.bound, tolerance=0.0)


def test_designs_side_by_side(design, tab):
    few = {"milestones": 300, "far_starts": 30, "certify_cells": 0, "complete_cells": 0}
    found = tilebind.compare([design, tab], by="bond_depth", progress=False, **few)
    table = pandas.DataFrame(found.table)
    assert len(found) == len(table) == 2 and set(table.name) == {"paper-tile", tab.name}
    assert table.bond_depth_J.is_monotonic_decreasing or table["rank"].tolist() == [1, 2]
    again = pickle.loads(pickle.dumps(found))
    assert again.summary() == found.summary() and "<html" in found.report_html()
    with pytest.raises(ValueError, match="selectivity"):
        tilebind.compare([design], by="beauty")
    with pytest.raises(ValueError, match="no design"):
        tilebind.compare([])


def test_sweeps_are_those_of_the_program(tab, program, root, tmp_path):
    key = "fixed.faces.east.profile.depth"
    few = {"milestones": 300, "far_starts": 30, "certify_cells": 0, "complete_cells": 0}
    found = tilebind.sweep(tab, {key: [0.01, 0.02, 5.0]}, progress=False, **few)
    table = pandas.DataFrame(found.table)
    assert table.status.tolist() == ["done", "done", "impossible"] and table.reason[2]
    assert table[key].tolist() == [0.01, 0.02, 5.0]
    options = [f"--{k.replace('_', '-')}={v}" for k, v in few.items()]
    run = [program, "sweep", str(root / "shapes/tab-20mm.toml"), "--vary", f"{key}=0.01,0.02,5.0"]
    subprocess.run([*run, "--out", str(tmp_path), "--quiet", *options], check=True)
    assert found.report == json.loads((tmp_path / "report.json").read_text())
    again = pickle.loads(pickle.dumps(found))
    assert again.summary() == found.summary()
    assert found.design(0) == again.design(0)
    assert found.design(0).to_dict()["fixed"]["faces"]["east"]["profile"]["depth"] == 0.01
    with pytest.raises(ValueError, match="cannot be varied"):
        tilebind.sweep(tab, {"magnet.colour": [1]})


def test_searches_are_those_of_the_program(tab, program, root, tmp_path):
    key = "fixed.faces.east.profile.depth"
    few = {"milestones": 300, "far_starts": 30, "certify_cells": 100, "complete_cells": 0}
    aim = {"maximise": "bond_depth", "subject": ["captured > 0.01", "selectivity > 1"], "points": 4}
    vary = {key: "0.01:0.02", "magnet.inset": [0.001, 0.002]}
    found = tilebind.search(tab, vary, **aim, progress=False, **few)
    options = [f"--{k.replace('_', '-')}={v}" for k, v in few.items()]
    run = [program, "sweep", str(root / "shapes/tab-20mm.toml"), "--vary", f"{key}=0.01:0.02", "--vary"]
    run += ["magnet.inset=0.001,0.002", "--maximise", "bond_depth", "--subject", "captured > 0.01"]
    run += ["--subject", "selectivity > 1", "--points", "4", "--out", str(tmp_path), "--quiet", *options]
    subprocess.run(run, check=True)
    assert found.report == json.loads((tmp_path / "report.json").read_text())
    [best] = found.front
    assert found.best == found.design(best)
    assert found.best.to_dict() == tilebind.Design.load(tmp_path / "best.toml").to_dict()
    assert found.best.to_dict()["magnet"]["inset"] == 0.001
    assert len(pandas.DataFrame(found.table)) == len(found) == 4
    again = pickle.loads(pickle.dumps(found))
    assert again.summary() == found.summary() and again.report == found.report
    for wrong in ({}, {"maximise": "depth"}, {"maximise": "captured", "subject": "captured"},
                  {"maximise": "captured", "points": 1}):
        with pytest.raises(ValueError):
            tilebind.search(tab, vary, **wrong)


def test_docking(design):
    found = design.dock(runs=40, seed=3, progress=False)
    assert len(found) == len(found.runs) == found.bound.of == 40
    ends = found.runs["end"].tolist()
    assert ends.count("bound") == found.bound.count
    assert found.bound.low <= found.bound.value <= found.bound.high
    again = pickle.loads(pickle.dumps(found))
    assert again.runs.tobytes() == found.runs.tobytes() and again.summary() == found.summary()
    path = found.trajectory(0)
    assert path["time_s"][0] == 0 and path["time_s"][-1] <= 5.0
    assert tilebind.dock(design, runs=40, seed=3, progress=False).runs.tobytes() == found.runs.tobytes()
    for wrong in ({"speed": (1, 0)}, {"drag": -1}, {"runs": 0}, {"orientation": float("nan")}):
        with pytest.raises(ValueError):
            design.dock(progress=False, **wrong)


def test_releases_are_those_of_the_program(program, root):
    paper = tilebind.Design.load(root / "shapes/paper-tile.toml")
    found = paper.releases(shaking=8e-3, runs=20, duration=2.0, seed=2, progress=False)
    run = [program, "dock", str(root / "shapes/paper-tile.toml"), "--from-bond", "--json", "--quiet"]
    run += ["--shaking", "8e-3", "--runs", "20", "--duration", "2", "--seed", "2"]
    assert found == json.loads(subprocess.run(run, check=True, capture_output=True).stdout)
    with pytest.raises(ValueError, match="shaking"):
        paper.releases(shaking=0.0)
    with pytest.raises(TypeError):
        paper.releases()


def test_forces_over_the_gap_give_the_remanence():
    design = tilebind.Design.load("tests/designs/good/flat.toml").replace("potential.model", "cuboid")
    gaps = np.array([0.0, 1.0, 2.0, 4.0, 8.0])
    poses = [design.bound + [1e-3 * gap, 0.0, 0.0] for gap in gaps]
    force = 0.9**2 * np.abs(design.wrench(poses)[:, 0])
    found = design.calibrate_gaps(pandas.DataFrame({"gap_mm": gaps, "force_N": force}))
    assert found["fits"] and abs(found["remanence_T"] / (0.9 * 1.2) - 1.0) < 1e-4



def test_kt_of_pairs_that_bind_and_part(design):
    rng = np.random.default_rng(1)
    frames = [
        pandas.DataFrame({"bound_s": rng.exponential(mean, 200), "apart_s": rng.exponential(10.0, 200)})
        for mean in (10.0, 100.0)
    ]
    hot, cold = [design.calibrate_bonds(frame, area=0.6) for frame in frames]
    assert 0 < cold["kT_J"] < hot["kT_J"]
    assert cold["kT_interval_J"][0] < cold["kT_J"] < cold["kT_interval_J"][1]
    with pytest.raises(ValueError):
        design.calibrate_bonds(frames[0][["bound_s"]])


def test_kt_of_distances(design):
    # Half of all pairs at contact, the others spread over the table.
    distances = np.concatenate([np.full(50, 0.431), np.sqrt(np.linspace(0.46**2, 0.7**2, 50))])
    found = design.calibrate_bonds(pandas.DataFrame({"distance_m": distances}), within=0.7)
    assert found["kT_interval_J"][0] < found["kT_J"] < found["kT_interval_J"][1]
    with pytest.raises(ValueError, match="line 3"):
        design.calibrate_bonds(pandas.DataFrame({"distance_m": [0.5, -1.0]}))


def test_words_and_crosstalk(design):
    found = tilebind.words(6, gap=0.4, seconds=2, progress=False)
    assert found["proved"] and found["count"] == len(found["words"]) == found["upper_bound"]
    strongest = np.array(tilebind.crosstalk(found["words"][:1], progress=False)["strongest_J"])
    assert strongest.shape == (2, 2) and strongest[0, 1] == strongest.min()
    spaced = tilebind.words(3, slots=7, gap=0.4, seconds=2, progress=False)
    assert all(len(word) == 7 and word.count(".") == 4 for word in spaced["words"])
    free = tilebind.words(4, continuous=True, pitch=0.02, count=2, seconds=1, progress=False)
    assert free["count"] == 2 and all(len(places) == 4 for places in free["positions_m"])
    assert all(np.diff(places).min() >= 0.02 - 1e-9 for places in free["positions_m"])
    for wrong in ({"slots": 7, "count": 2}, {"pitch": 0.005, "count": 2}, {}, {"count": 2, "shape": "polar"}):
        with pytest.raises(ValueError):
            tilebind.words(4, continuous=True, **wrong)
    with pytest.raises(ValueError, match="continuous"):
        tilebind.words(4, face=0.3)
    with pytest.raises(tilebind.DesignError):
        tilebind.crosstalk(["NXS"])
    with pytest.raises(ValueError):
        tilebind.words(0)


def test_what_has_no_end_is_refused(design, root):
    for refused in (
        lambda: design.analyse(far_starts=10**12),
        lambda: design.analyse(far_starts=10**18),
        lambda: design.analyse(milestones=10**14),
        lambda: design.dock(runs=10**12),
        lambda: design.yields([3e-3], tiles=4, time=60, runs=10**12),
        lambda: design.barrier(design.bound, milestones=10**14),
        lambda: tilebind.assemble(root / "shapes/assemblies/spiral.yaml", kt=5e-3, length=0),
        lambda: tilebind.assemble(root / "shapes/assemblies/spiral.yaml", kt=5e-3, proofread=7),
        lambda: design.dock(runs=2, duration=1).trajectory(0, interval=1e-300),
    ):
        with pytest.raises((ValueError, MemoryError)):
            refused()


def test_starts_that_are_alike_are_drawn(design):
    for starts in ({"speed": (0.5, 0.5)}, {"speed": (0, 0)}, {"orientation": 0}):
        assert "</svg>" in design.dock(runs=10, duration=1, **starts).svg()


def test_wrong_arguments_are_told(design):
    with pytest.raises(TypeError, match="milestones"):
        design.analyse(milestone=3)
    with pytest.raises(ValueError, match="seed = one"):
        design.analyse(seed="one")
    for wrong in ({"milestones": 0}, {"tolerance": -1.0}, {"settled": 2.0}, {"kinds": 0}, {"milestones": 10**12}):
        with pytest.raises(ValueError):
            design.analyse(**wrong)


def test_shaken_tiles(design, analysis):
    left = design.exits([0.43, -0.04, 0], kt=3.037e-3, basin_energy=-0.03, free_at=0.75)
    # Brownian motion step by step: 0.0176 +- 0.0004 m^2 over D, 0.405 +- 0.01 bound.
    assert left["mean_exit_s"] * left["diffusion_m2_s"] == pytest.approx(0.0176, abs=0.0008)
    assert left["exits"]["bound"] == pytest.approx(0.405, abs=0.02)
    held = analysis.bond(3e-3, 0.3)
    assert held["ln_K"] == pytest.approx(held["bond_kT"] - held["docking_cost_kT"])
    with pytest.raises(ValueError, match="kt"):
        design.exits([0.43, -0.04, 0], kt=-1)
    with pytest.raises(ValueError, match="no longer have bounds"):
        design.exits([0.43, -0.04, 0], kt=3e-3, certify=0.1)
    assert left["mean_exit_bounds_s"] is None and 0 < left["mean_exit_error"] < 0.05
    with pytest.raises(ValueError, match="no longer have bounds"):
        analysis.rates(3e-3, certify=0.1)
    with pytest.raises(ValueError, match="coverage"):
        analysis.bond(3e-3, 30)
    with pytest.raises(ValueError, match="kt"):
        analysis.rates(0.0)


def test_yields(design):
    found = design.yields([3e-3], tiles=4, time=60.0, runs=20, duration=2.0, simulations=0, progress=False)
    assert found["design"]["name"] == design.name
    for wrong in ({"tiles": 3}, {"time": 0.0}, {"coverage": 1.0}, {"runs": 0}):
        with pytest.raises(ValueError):
            design.yields([3e-3], **({"tiles": 4, "time": 60.0} | wrong))


def test_tile_sets_of_words(root):
    tiles = root / "shapes/assemblies" / "unary-square.yaml"
    found = tilebind.words(10, gap=0.4, seconds=1, progress=False)
    files = tilebind.assemble(tiles, found["words"], kt=3e-3, progress=False)
    assert {"assembly.yaml", "assembly.tiles", "matrix.csv", "report.json"} <= files.keys()
    sought = tilebind.assemble(tiles, kt=3e-3, gap=0.3, seconds=1, progress=False)
    assert sought.keys() >= {"words.toml", "report.json"} and b"words = [" in sought["words.toml"]
    with pytest.raises(ValueError, match="positions"):
        tilebind.assemble(tiles, kt=3e-3, length=3, magnets=4)
    with pytest.raises(ValueError):
        tilebind.assemble(tiles, found["words"][:1], kt=3e-3)
    with pytest.raises(tilebind.DesignError):
        tilebind.assemble(root / "shapes/paper-tile.toml", found["words"], kt=3e-3)
