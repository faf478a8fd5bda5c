"""Designs: read, made, varied; what is wrong with them."""

import copy
import io
import pickle

import numpy as np
import pytest
import tilebind
from tilebind import Design, DesignError


def test_a_design_says_what_it_is(design):
    assert design.name == "paper-tile" and design.model == "dipole"
    assert design.bound.tolist() == [0.43, 0.0, 0.0]
    assert design.table == (2.0, 2.0)
    assert len(design.magnets("fixed")) == 16 and design.outline("moving").shape == (4, 2)
    assert design.magnets("fixed")["moment_A_m2"][0] == pytest.approx(0.2865, rel=1e-3)
    assert "bind" in design.summary() and design.svg().startswith("<svg")
    assert isinstance(design.show(), dict)


def test_text_and_dictionaries_make_the_same_design(design, root):
    same = Design.loads((root / "shapes/paper-tile.toml").read_text(), file=str(root / "shapes/paper-tile.toml"))
    assert same == design and hash(same) == hash(design)
    made = Design.from_dict(design.to_dict())
    poses = [[0.43, 0, 0], [0.5, 0.1, 0.3]]
    assert np.array_equal(made.energy(poses), design.energy(poses))
    assert made == design and hash(made) == hash(design) and made != "a design"
    assert made != design.replace("magnet.pitch", 0.041)
    bare = Design.from_dict({key: value for key, value in design.to_dict().items() if key != "name"})
    assert Design.from_dict(bare.to_dict()) == bare != design
    with pytest.raises(FileNotFoundError, match="nowhere"):
        Design.load("nowhere.toml")


def test_a_key_is_replaced_in_another_design(tab):
    deeper = tab.replace("fixed.faces.east.profile.depth", 0.025)
    assert deeper.to_dict()["fixed"]["faces"]["east"]["profile"]["depth"] == 0.025
    assert tab.to_dict()["fixed"]["faces"]["east"]["profile"]["depth"] == 0.02
    assert deeper.name == tab.name and deeper != tab
    assert tab.replace("table.size", np.array([3.0, 2.0])).table == (3.0, 2.0)
    assert tab.replace("table.size.0", "250 cm").table == (2.5, 2.0)
    with pytest.raises(DesignError, match="does not exist"):
        tab.replace("name.first", 1)
    with pytest.raises(DesignError, match="fixed.side = -1: `side` must be above zero") as found:
        tab.replace("fixed.side", -1)
    assert found.value.line is None
    with pytest.raises(ValueError, match="not a object"):
        tab.replace("fixed.side", object())


def test_errors_tell_line_column_and_fix(root):
    text = (root / "shapes/paper-tile.toml").read_text().replace("side = 0.43", "side = 430", 1)
    with pytest.raises(DesignError) as caught:
        Design.loads(text + "\n[tabel]\n", file="my.toml")
    error = caught.value
    line = 1 + text[: text.index("side = 430")].count("\n")
    assert (error.file, error.line, error.column) == ("my.toml", line, 8)
    assert "0.43" in error.message + error.fix
    assert error.mend == error.fix
    assert f"my.toml:{line}:8" in str(error) and "help:" in str(error)
    assert len(error.also) == 1 and "tabel" in error.also[0].message
    for again in (pickle.loads(pickle.dumps(error)), copy.copy(error)):
        assert (again.line, again.fix, str(again)) == (error.line, error.fix, str(error))
    assert isinstance(error, ValueError)
    with pytest.raises(FileNotFoundError, match="no/such/file.toml"):
        Design.load("no/such/file.toml")


def test_designs_do_not_change_and_travel(design, tab, root):
    with pytest.raises(AttributeError):
        design.name = "another"
    with pytest.raises(ValueError):
        design.bound[0] = 1.0
    for one in (design, tab, Design.load(root / "shapes/drawn-wave.toml")):
        again = pickle.loads(pickle.dumps(one))
        assert again == one and again.sha256 == one.sha256
        assert again.energy(one.bound) == one.energy(one.bound)
        assert copy.deepcopy(one) == one
    with pytest.raises(ValueError, match="not a tilebind result"):
        Design._restore(b"\x00")


def test_outlines_fit(tab):
    found = tab.matches(3)
    assert len(found) == 3 and np.all(np.diff(found["contact_m"]) <= 0)


def test_the_version_is_told():
    assert tilebind.__version__.count(".") == 2


def test_files_for_the_workshop(design):
    files = design.make(kerf=0.0002)
    drawings = {"fixed.dxf", "fixed.svg", "moving.dxf", "moving.svg"}
    checks = {name for name in files if name.startswith("check")}
    assert checks and set(files) == drawings | checks | {"sheet.md"}
    assert b"CUT_OUTSIDE" in files["fixed.dxf"] and b"mm" in files["sheet.md"]
    with pytest.raises(ValueError, match="kerf"):
        design.make(kerf=0.15)


def test_cad_programs_read_the_workshop_files():
    """What ezdxf makes of them: no fault, millimetres, the arc of the profile as one arc."""
    ezdxf = pytest.importorskip("ezdxf")
    text = """
        table = { size = [2.0, 2.0] }
        target = { fixed = "east", moving = "west" }
        [fixed]
        side = 0.1
        thickness = 0.02
        mass = 0.3
        faces.east.profile = { shape = "arc", width = 0.06, depth = 0.005 }
        [moving]
        side = 0.1
        thickness = 0.02
        mass = 0.3
        faces.west.mates = "east"
    """
    files = Design.loads(text).make(kerf=0.0)
    for name, sign in [("fixed.dxf", 1), ("moving.dxf", -1)]:
        drawing = ezdxf.read(io.StringIO(files[name].decode()))
        assert not drawing.audit().errors and not drawing.audit().fixes
        assert drawing.units == ezdxf.units.MM and drawing.header["$MEASUREMENT"] == 1
        assert {"CUT_OUTSIDE", "CUT_INSIDE", "ENGRAVE"} <= {layer.dxf.name for layer in drawing.layers}
        [outline] = drawing.modelspace().query("LWPOLYLINE[layer=='CUT_OUTSIDE']")
        bulges = [bulge for *_, bulge in outline.get_points("xyb") if bulge]
        # A segment 5 high over 60 wide: the tangent of a quarter of its angle is 2 * 5 / 60.
        assert bulges == pytest.approx([sign / 6], abs=1e-9)


def test_drawings_for_browsers_agree_with_those_for_cutters():
    """Each SVG file, read by svgelements, has the shapes of its DXF file, layer by layer, in mm."""
    svg = pytest.importorskip("svgelements")
    ezdxf = pytest.importorskip("ezdxf")
    from ezdxf import bbox
    text = """
        table = { size = [1.0, 1.0] }
        target = { fixed = "east", moving = "west" }
        [magnet]
        shape = "disc"
        diameter = "6 mm"
        height = "3 mm"
        axis = "up"
        remanence = 1.2
        pitch = 0.012
        inset = 0.002
        [fixed]
        side = 0.06
        thickness = "6 mm"
        mass = "20 g"
        faces.east = { code = "UUD", profile = { shape = "arc", width = 0.04, depth = 0.004 } }
        [moving]
        side = 0.06
        thickness = "6 mm"
        mass = "20 g"
        faces.west.mates = "east"
    """
    files = Design.loads(text).make(copies=3, sheet="300x200 mm")
    for name in ("fixed", "moving", "nested-1"):
        drawing = ezdxf.read(io.StringIO(files[f"{name}.dxf"].decode()))
        lines = {layer: list(drawing.modelspace().query(f"*[layer=='{layer}']"))
                 for layer in ("CUT_INSIDE", "CUT_OUTSIDE")}
        assert lines["CUT_INSIDE"] and all(line.dxftype() == "CIRCLE" for line in lines["CUT_INSIDE"])
        assert all(line.dxf.radius == pytest.approx(3.1) for line in lines["CUT_INSIDE"])
        page = svg.SVG.parse(io.BytesIO(files[f"{name}.svg"]), ppi=25.4)
        for layer, own in lines.items():
            group = page.get_element_by_id(layer)
            shapes = [shape for shape in group.select() if isinstance(shape, svg.Shape)]
            assert len(shapes) == len(own)
            for shape, line in zip(shapes, own):
                box = bbox.extents([line])
                low_x, low_y, high_x, high_y = svg.Path(shape).bbox()
                size = (high_x - low_x, high_y - low_y)
                assert size == pytest.approx((box.size.x, box.size.y), abs=2e-3)
                if name == "nested-1":
                    at = (low_x, page.height - high_y)
                    assert at == pytest.approx((box.extmin.x, box.extmin.y), abs=2e-3)


def test_parts_on_sheets_are_apart():
    """Read by ezdxf, measured by shapely: outlines with their arcs, layer by layer."""
    ezdxf = pytest.importorskip("ezdxf")
    geometry = pytest.importorskip("shapely.geometry")
    from ezdxf import path
    text = """
        table = { size = [2.0, 2.0] }
        target = { fixed = "0", moving = "SIDE" }
        magnet = { size = [0.002, 0.006, 0.004], remanence = 1.2, pitch = 0.012, inset = INSET }
        [fixed]
        side = 0.05
        sides = SIDES
        thickness = "6 mm"
        mass = "30 g"
        faces.0 = { code = "NS", profile = { shape = "arc", width = 0.04, depth = 0.004 } }
        [moving]
        side = 0.05
        sides = SIDES
        thickness = "6 mm"
        mass = "30 g"
        faces.SIDE.mates = "0"
    """
    for sides, inset, layers in [(3, 0.001, None), (5, 0.0, "2 mm,4 mm"), (6, 0.002, "3 mm,3 mm")]:
        filled = text.replace("SIDES", str(sides)).replace("SIDE", str(sides // 2)).replace("INSET", str(inset))
        files = Design.loads(filled).make(
            kerf=2e-4, count="5,4", sheet="300x250 mm", spacing=1.5e-3, **({"layers": layers} if layers else {})
        )
        parts = 0
        for name in (name for name in files if name.startswith("nested") and name.endswith(".dxf")):
            drawing = ezdxf.read(io.StringIO(files[name].decode()))
            assert not drawing.audit().errors and not drawing.audit().fixes
            assert drawing.units == ezdxf.units.MM
            lines = list(drawing.modelspace())
            order = [line.dxf.layer for line in lines]
            work = ["ENGRAVE", "CUT_INSIDE", "CUT_OUTSIDE"]
            assert order == sorted(order, key=work.index)
            flat = [
                geometry.Polygon([(p.x, p.y) for p in path.make_path(line).flattening(0.001)])
                for line in lines
                if line.dxf.layer == "CUT_OUTSIDE"
            ]
            parts += len(flat)
            frame = geometry.box(0, 0, 300, 250).exterior
            for k, part in enumerate(flat):
                assert part.is_valid and part.distance(frame) > 1.49
                assert all(part.distance(other) > 1.49 for other in flat[:k])
            texts = [line for line in lines if line.dxftype() == "TEXT"]
            assert texts and all(line.dxf.height >= 2 for line in texts)
        assert parts == 9 * (1 if layers is None else 2)


def test_shields_are_fitted_to_measurements(root):
    pandas = pytest.importorskip("pandas")
    true = Design.load(root / "shapes/shielded-backs.toml")
    tables = true.to_dict()
    bare = Design.from_dict({
        **{key: value for key, value in tables.items() if key != "shield"},
        "moving": {**tables["moving"], "faces": {"all": {"code": "NS"}}},
        "fixed": {**tables["fixed"], "faces": {"all": {"code": "NS"}}},
    })
    poses = [[0.081 + 0.003 * k, 0.004 * k - 0.03, 0.5 * k] for k in range(40)]
    poses = [pose for pose in poses if true.is_free(pose)]
    assert len(poses) > 15
    rows = [(*pose, iron, d.energy(pose)) for pose in poses for iron, d in ((1, true), (0, bare))]
    table = pandas.DataFrame(rows, columns=["x_m", "y_m", "theta_rad", "iron", "energy_J"])
    found = true.replace("shield.length", 0.02).calibrate(table)
    assert found["shield"]["length_m"] == pytest.approx(0.03, rel=1e-3)
    with pytest.raises(ValueError, match="hold_out"):
        true.calibrate(table, hold_out=1)
