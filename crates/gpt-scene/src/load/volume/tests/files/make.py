"""Makes the files beside this one, by OpenVDB 10.0.1 (Debian: python3-openvdb, libopenvdb-tools, libnanovdb-tools): grids whose values are
simple functions of the index, which the tests know too. The files are kept compressed by gzip."""
import gzip
import pathlib
import subprocess
import tempfile

import pyopenvdb as vdb

BACKGROUND = 0.25


def active(i, j, k):
    return (i * 3 + j * 5 + k * 11) % 7 < 3


def value(i, j, k):
    return ((i * 7 + j * 13 + k * 29) % 32 + 1) / 16


def inactive(i, j, k):
    """Inactive values of each leaf differ, since each case is compressed in its own way."""
    leaf = i >> 3
    total = i + j + k
    return [BACKGROUND, 0.5, (BACKGROUND, 0.5)[total % 2], (0.5, 2.0)[total % 2], (total % 5) / 4, None][leaf]


def scalar():
    grid = vdb.FloatGrid(BACKGROUND)
    voxels = grid.getAccessor()
    for i in range(48):
        for j in range(8):
            for k in range(8):
                if i >> 3 == 5 or active(i, j, k):
                    voxels.setValueOn((i, j, k), value(i, j, k))
                else:
                    voxels.setValueOff((i, j, k), inactive(i, j, k))
    voxels.setValueOn((60, 4, 4), 3.0)
    grid.fill((-8, 0, 0), (-1, 7, 7), 0.75, True)
    grid.fill((48, 0, 0), (55, 7, 7), 1.5, False)
    grid.name = "density"
    grid.transform = vdb.createLinearTransform([[0.5, 0, 0, 0], [0, 0.5, 0, 0], [0, 0, 0.5, 0], [1, 2, 3, 1]])
    return grid


def vector():
    grid = vdb.Vec3SGrid((0, 0, 0))
    grid.name = "color"
    voxels = grid.getAccessor()
    for i in range(8):
        for j in range(8):
            for k in range(8):
                if active(i, j, k):
                    red = value(i, j, k)
                    voxels.setValueOn((i - 4, j + 8, k), (red, red / 2, red + 1))
    grid.transform = vdb.createLinearTransform([[0, 2, 0, 0], [-2, 0, 0, 0], [0, 0, 1, 0], [5, 6, 7, 1]])
    return grid


def cube(name, side, content):
    grid = vdb.FloatGrid(0)
    grid.name = name
    grid.fill((0, 0, 0), (side - 1, side - 1, side - 1), content, True)
    return grid


def write(folder):
    def save(name, grids):
        vdb.write(str(folder / name), grids)

    def run(*words):
        subprocess.run(words, check=True, cwd=folder, stdout=subprocess.DEVNULL)

    save("scalar.vdb", scalar())
    half = scalar()
    half.saveFloatAsHalf = True
    save("half.vdb", half)
    mask = vdb.BoolGrid()
    mask.name = "mask"
    mask.fill((0, 0, 0), (1, 1, 1), True, True)
    save("several.vdb", [vector(), cube("temperature", 4, 1000.0), cube("density", 1, 9.0), mask])
    save("vector.vdb", vector())
    level_set = vdb.createLevelSetSphere(radius=2.0, voxelSize=0.5)
    level_set.name = "surface"
    save("level_set.vdb", level_set)
    save("nan.vdb", cube("density", 1, float("nan")))
    wide = cube("density", 1, 1.0)
    wide.getAccessor().setValueOn((20000, 20000, 20000), 1)
    save("wide.vdb", wide)
    empty = vdb.FloatGrid(0)
    empty.name = "density"
    save("empty.vdb", empty)
    for codec in ["zip", "none", "active"]:
        run("vdb_tool", "-read", "scalar.vdb", "-write", f"codec={codec}", f"scalar_{codec}.vdb")
    run("vdb_tool", "-read", "half.vdb", "-write", "codec=zip", "bits=16", "half_zip.vdb")
    run("nanovdb_convert", "-f", "scalar.vdb", "scalar_none.nvdb")
    run("nanovdb_convert", "-b", "-f", "scalar.vdb", "scalar_blosc.nvdb")
    for name in ["scalar", "vector", "several"]:
        run("nanovdb_convert", "-z", "-f", f"{name}.vdb", f"{name}.nvdb")
    for bits in ["fp4", "fp8", "fp16", "fpN"]:
        run("nanovdb_convert", "-z", "-f", f"--{bits}", "scalar.vdb", f"{bits}.nvdb")


if __name__ == "__main__":
    target = pathlib.Path(__file__).parent
    with tempfile.TemporaryDirectory() as name:
        write(pathlib.Path(name))
        for path in sorted(pathlib.Path(name).iterdir()):
            (target / f"{path.name}.gz").write_bytes(gzip.compress(path.read_bytes(), 9, mtime=0))
