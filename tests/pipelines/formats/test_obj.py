"""An OBJ has the triangles and the photographs of the city that is shown."""

import zipfile
from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image
from scipy.spatial import cKDTree

from tests.pipelines.formats.shown_city import glb


def unzipped(out: Path, folder: Path, block: str) -> Path:
    with zipfile.ZipFile(out / "obj" / f"{block}.zip") as file:
        file.extractall(folder)
    return folder


def test_an_obj_has_the_glb_s_triangles_and_area(
    globe: Path, out: Path, tmp_path: Path
) -> None:
    unzipped(out, tmp_path, "1")
    assert [one.name for one in tmp_path.glob("*.obj")] == ["1.obj"]
    assert [one.name for one in tmp_path.glob("*.mtl")] == ["1.mtl"]
    obj = trimesh.load_scene(tmp_path / "1.obj", process=False, split_objects=True)
    shown = glb(globe, "1")
    named = {name.removesuffix("_photograph"): m for name, m in obj.geometry.items()}
    assert set(named) == set(shown.geometry)
    for name, mesh in shown.geometry.items():
        other = named[name]
        assert other.area == pytest.approx(mesh.area, rel=1e-4)
        np.testing.assert_allclose(other.bounds, mesh.bounds, atol=1e-4)
        assert cKDTree(other.vertices).query(mesh.vertices)[0].max() < 1e-4
        assert cKDTree(mesh.vertices).query(other.vertices)[0].max() < 1e-4


def test_an_obj_wears_the_photographs_the_right_way_up(
    globe: Path, out: Path, tmp_path: Path
) -> None:
    unzipped(out, tmp_path, "1")
    obj = trimesh.load(tmp_path / "1.obj", process=False, force="mesh")
    one, two = (
        np.column_stack([mesh.vertices, mesh.visual.uv])
        for mesh in (obj, glb(globe, "1").to_geometry())
    )
    assert cKDTree(one).query(two)[0].max() < 1e-3
    assert cKDTree(two).query(one)[0].max() < 1e-3
    sizes = set()
    for name in ("1.png", "1-opacity.png", "1-evidence.png"):
        with Image.open(tmp_path / name) as picture:
            sizes.add(picture.size)
    assert len(sizes) == 1
