"""Conversion to and from magpylib."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

#: Angles (rad) and lengths (as a share of a magnet's size) closer than this are equal.
_SAME = 1e-9


def collections(design, poses=None):
    """The fixed and the moving tile's magnets, the moving ones along a path of poses."""
    import magpylib

    poses = np.atleast_2d(design.bound if poses is None else np.asarray(poses, dtype=float))
    fixed, moving = (
        magpylib.Collection(*map(_cuboid, design.magnets(tile)), style_label=tile)
        for tile in ("fixed", "moving")
    )
    # About the tile's reference point, which is the collection's position.
    x, y, theta = poses.T
    moving.rotate_from_angax(theta, "z", anchor=(0, 0, 0), start=0, degrees=False)
    moving.move(np.stack([x, y, 0 * x], axis=-1), start=0)
    return fixed, moving


def _cuboid(magnet):
    import magpylib
    from scipy.spatial.transform import Rotation

    return magpylib.magnet.Cuboid(
        dimension=[magnet[k] for k in ("length_m", "width_m", "height_m")],
        polarization=(magnet["remanence_T"], 0, 0),
        position=(magnet["x_m"], magnet["y_m"], 0),
        orientation=Rotation.from_euler("z", magnet["angle_rad"]),
    )


class Tile(Mapping):
    """A tile, as under ``fixed`` or ``moving`` in a design. Immutable.

    Parameters
    ----------
    entries : Mapping
        The keys of the design file: side (or sides, vertices), thickness, mass, faces.

    Examples
    --------
    >>> tile = tilebind.Tile({"side": 0.43, "thickness": 0.013, "mass": 0.1,
    ...                       "faces": {"all": {"code": "NNNS"}}})
    >>> tilebind.Design.from_dict({"fixed": tile, "moving": tile, ...})
    """

    __slots__ = ("_entries",)

    def __init__(self, entries: Mapping[str, Any]):
        object.__setattr__(self, "_entries", copy.deepcopy(dict(entries)))

    def __setattr__(self, name, value):
        raise AttributeError("a Tile never changes; make another one")

    def __getitem__(self, key: str) -> Any:
        return copy.deepcopy(self._entries[key])

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)

    def __len__(self) -> int:
        return len(self._entries)

    def __repr__(self) -> str:
        return f"Tile({self._entries!r})"

    def __reduce__(self):
        return Tile, (self._entries,)

    @classmethod
    def from_magpylib(
        cls,
        magnets,
        *,
        thickness: float,
        mass: float,
        side: float | None = None,
        sides: int = 4,
        vertices=None,
    ) -> "Tile":
        """A tile with straight faces and the magnets of a collection.

        Parameters
        ----------
        magnets : magpylib.Collection or sequence of magpylib.magnet.Cuboid
            In the tile's frame, in the plane z = 0, rotated only about z and magnetised along a
            side in the plane. Only a path's first position is used.
        thickness, mass : float
            Thickness (m) and mass (kg) of the tile.
        side : float, optional
            Side length (m) of a regular tile with `sides` sides, centred on the origin.
        sides : int, optional
        vertices : array_like, optional
            (n, 2) in m, counter-clockwise, instead of `side`.

        Returns
        -------
        Tile
            Each magnet belongs to its nearest face.
        """
        if (side is None) == (vertices is None):
            raise ValueError("give either side or vertices")
        if vertices is None:
            outline: dict[str, Any] = {"side": float(side)}
            if sides != 4:
                outline["sides"] = int(sides)
            corners = _regular(float(side), int(sides))
        else:
            corners = np.asarray(vertices, dtype=float)
            outline = {"vertices": corners.tolist()}
        faces: dict[str, list] = {str(k): [] for k in range(len(corners))}
        for magnet in getattr(magnets, "sources_all", magnets):
            face, entry = _entry(corners, *_block(magnet))
            faces[str(face)].append(entry)
        for listed in faces.values():
            listed.sort(key=lambda entry: entry["at"])
        tables = {face: {"magnets": listed} for face, listed in faces.items() if listed}
        return cls({**outline, "thickness": thickness, "mass": mass, "faces": tables})


def _regular(side, sides):
    """Corners of a regular tile; face 0 has its outward normal along +x."""
    radius = side / 2 / np.sin(np.pi / sides)
    angles = (2 * np.arange(sides) - 1) * np.pi / sides
    return radius * np.stack([np.cos(angles), np.sin(angles)], axis=-1)


def _block(magnet):
    """Centre, angle of the moment, size along and across it, and remanence of a cuboid."""
    size = np.array(magnet.dimension, dtype=float)
    position = np.atleast_2d(magnet.position)[0]
    matrix = np.reshape(magnet.orientation.as_matrix(), (-1, 3, 3))[0]
    polarization = np.array(magnet.polarization, dtype=float)
    if abs(position[2]) > _SAME * size[2] or abs(matrix[2, 2]) < 1 - _SAME:
        raise ValueError("tiles are flat: magnets must lie in the plane z = 0, rotated only about z")
    along = int(np.argmax(np.abs(polarization)))
    rest = np.delete(polarization, along)
    if along == 2 or np.any(np.abs(rest) > _SAME * abs(polarization[along])):
        raise ValueError("a magnet is magnetised along one of its sides in the plane")
    moment = matrix @ polarization
    if along == 1:
        size = size[[1, 0, 2]]
    return position[:2], np.arctan2(moment[1], moment[0]), size, np.linalg.norm(polarization)


def _entry(corners, centre, angle, size, remanence):
    """The nearest face of a magnet, and its entry there."""
    starts, ends = corners, np.roll(corners, -1, axis=0)
    along = ends - starts
    length = np.linalg.norm(along, axis=1)
    tangent = along / length[:, None]
    normal = np.stack([tangent[:, 1], -tangent[:, 0]], axis=-1)
    offset = centre - (starts + ends) / 2
    s, h = np.sum(offset * tangent, axis=1), np.sum(offset * normal, axis=1)
    beyond = np.maximum(np.abs(s) - length / 2, 0)
    face = int(np.argmin(np.hypot(h, beyond)))
    outward = np.arctan2(normal[face, 1], normal[face, 0])
    turn = np.angle(np.exp(1j * (angle - outward)))
    pole = "N" if abs(turn) <= np.pi / 2 + _SAME else "S"
    axis = turn if pole == "N" else np.angle(np.exp(1j * (turn - np.pi)))
    if abs(axis) < _SAME:
        axis = 0.0
    reach = (size[0] * abs(np.cos(axis)) + size[1] * abs(np.sin(axis))) / 2
    inset = -h[face] - reach
    entry = {
        "at": float(s[face]),
        "pole": pole,
        "size": [float(length) for length in size],
        "remanence": float(remanence),
        "inset": 0.0 if abs(inset) < _SAME * size[0] else float(inset),
        "axis": float(axis),
    }
    return face, entry
