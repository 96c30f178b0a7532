#!/usr/bin/env python3
"""Reads what the example `write_samples` wrote with the readers that users have.

    cargo run -p granular-io --example write_samples FOLDER
    python crates/io/tests/read_back.py FOLDER

Needs vtk, pandas and numpy. The .vtkhdf files are checked when they are there, and must be there
with --hdf5. Exits non-zero when a name, time or value differs.
"""

import struct
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

import numpy as np
import pandas as pd
import vtk
from vtk.util.numpy_support import vtk_to_numpy

np.set_printoptions(precision=17)
TIMES = [0.0, 0.1 + 0.2, 1.5e-7]


def same(what, found, wanted):
    found, wanted = np.asarray(found), np.asarray(wanted)
    if found.shape != wanted.shape or not np.array_equal(found, wanted):
        raise AssertionError(f"{what}: found {found}, wanted {wanted}")


def fields(n, step):
    """As `show` in the example."""
    at = np.arange(n) + 10.0 * step
    one = np.ones(n)
    return {
        "radius": 1e-3 * (1.0 + at),
        "density": (0.5 + at).astype(np.float32),
        "velocity": np.stack([at, -at, 0.25 * one], axis=1),
        "flow": np.stack([at, 2.0 * one, 0.0 * one], axis=1),
        "stress": np.stack([at, one, 2 * one, 3 * one, 4 * one, 5 * one], axis=1),
        "id": (np.uint32(0xFFFFFFFF) - np.arange(n, dtype=np.uint32)),
    }


def check_fields(what, data, n, step):
    names = [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())]
    wanted = fields(n, step)
    same(f"{what} names", sorted(names), sorted(wanted))
    for name, values in wanted.items():
        array = vtk_to_numpy(data.GetArray(name))
        same(f"{what} {name}", array, values)
        if name in ("density", "id"):
            same(f"{what} {name} type", str(array.dtype), str(values.dtype))


def check_field_data(what, output, step, time, units):
    data = output.GetFieldData()
    same(f"{what} time", data.GetArray("TimeValue").GetValue(0), time)
    same(f"{what} number", data.GetArray("kinetic_energy").GetValue(0), 0.5 * 10 * step)
    found = data.GetAbstractArray("units")
    found = [found.GetValue(i) for i in range(found.GetNumberOfValues())]
    for unit in units:
        if unit not in found:
            raise AssertionError(f"{what} units: {unit!r} is not in {found}")


def read_xml(reader, path):
    errors = []
    reader.AddObserver("ErrorEvent", lambda *_: errors.append(path))
    reader.SetFileName(str(path))
    reader.Update()
    if errors or reader.GetErrorCode():
        raise AssertionError(f"VTK cannot read {path}")
    return reader.GetOutput()


def positions(step):
    n = 4 + step
    return np.stack([np.arange(n) + 0.5, np.full(n, 0.1 * step), np.zeros(n)], axis=1)


def check_points(folder):
    sets = xml.parse(folder / "points.pvd").getroot().findall("Collection/DataSet")
    same("pvd times", [float(s.get("timestep")) for s in sets], TIMES)
    for step, entry in enumerate(sets):
        what = entry.get("file")
        output = read_xml(vtk.vtkXMLPolyDataReader(), folder / what)
        n = 4 + step
        same(f"{what} points", vtk_to_numpy(output.GetPoints().GetData()), positions(step))
        same(f"{what} vertices", [output.GetNumberOfVerts(), output.GetNumberOfCells()], [n, n])
        same(f"{what} ids", vtk_to_numpy(output.GetVerts().GetConnectivityArray()), np.arange(n))
        check_fields(what, output.GetPointData(), n, step)
        check_field_data(what, output, step, TIMES[step], ["velocity: m/s", "density: kg/m³"])
        check_links(folder, step)


def check_links(folder, step):
    what = f"links-{step}.vtp"
    output = read_xml(vtk.vtkXMLPolyDataReader(), folder / what)
    n = 3 + step
    same(f"{what} lines", output.GetNumberOfLines(), n)
    ends = np.stack([np.arange(n), np.arange(n) + 1], axis=1).ravel()
    same(f"{what} ends", vtk_to_numpy(output.GetLines().GetConnectivityArray()), ends)
    force = vtk_to_numpy(output.GetCellData().GetArray("normal_force"))
    same(f"{what} force", force, fields(n, step)["radius"])
    check_field_data(what, output, step, TIMES[step], ["normal_force: N"])


def check_empty(folder):
    for what in ["empty.vtp", "empty-links.vtp"]:
        output = read_xml(vtk.vtkXMLPolyDataReader(), folder / what)
        same(f"{what} counts", [output.GetNumberOfPoints(), output.GetNumberOfCells()], [0, 0])


def check_image(what, output, cells_along_z, step):
    extent = (0, 4, 0, 3, 0, 0 if cells_along_z == 1 else cells_along_z)
    same(f"{what} extent", output.GetExtent(), extent)
    same(f"{what} origin", output.GetOrigin(), (0.5, -1.0, 0.0))
    same(f"{what} spacing", output.GetSpacing(), (0.1, 0.2, 0.3))
    same(f"{what} cells", output.GetNumberOfCells(), 12 * cells_along_z)
    check_fields(what, output.GetCellData(), 12 * cells_along_z, step)


def check_images(folder):
    for name, cells_along_z in [("plane", 1), ("space", 2)]:
        output = read_xml(vtk.vtkXMLImageDataReader(), folder / f"{name}.vti")
        check_image(f"{name}.vti", output, cells_along_z, 1)
        check_field_data(f"{name}.vti", output, 1, TIMES[1], ["stress: Pa"])


def check_table(folder):
    path = folder / "series.csv"
    table = pd.read_csv(path)
    same("csv header", list(table.columns), ["value [J]", "high_bits [-]", "low_bits [-]"])
    bits = [(int(h) << 32) | int(l) for h, l in zip(table["high_bits [-]"], table["low_bits [-]"])]
    exact = np.array([struct.unpack("<d", struct.pack("<Q", b))[0] for b in bits])
    if len(table) < 900:
        raise AssertionError("csv rows are missing")
    if not np.array_equal(table["value [J]"], exact):
        # Before version 3 pandas rounds unless it is asked not to.
        table = pd.read_csv(path, float_precision="round_trip")
    same("csv values", table["value [J]"], exact)


def read_hdf(path):
    reader = vtk.vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    times = reader.GetOutputInformation(0).Get(vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    for step, time in enumerate(times or []):
        reader.UpdateTimeStep(time)
        output = reader.GetOutputDataObject(0)
        if output.GetNumberOfCells() == 0:
            raise AssertionError(f"{path} step {step} is empty")
        energy = output.GetFieldData().GetArray("kinetic_energy")
        same(f"{path.name} step {step} number", vtk_to_numpy(energy), [0.5 * 10 * step])
        yield step, time, output


def check_hdf(folder):
    seen = []
    for step, time, output in read_hdf(folder / "points.vtkhdf"):
        n, what = 4 + step, f"points.vtkhdf step {step}"
        seen.append(time)
        same(f"{what} count", [output.GetNumberOfPoints(), output.GetNumberOfVerts()], [n, n])
        same(f"{what} points", vtk_to_numpy(output.GetPoints().GetData()), positions(step))
        same(f"{what} ids", vtk_to_numpy(output.GetVerts().GetConnectivityArray()), np.arange(n))
        check_fields(what, output.GetPointData(), n, step)
    same("points.vtkhdf times", seen, [0.0, 0.5, 1.0, 1.5])
    for name, cells_along_z in [("plane", 1), ("space", 2)]:
        seen = []
        for step, time, output in read_hdf(folder / f"{name}.vtkhdf"):
            seen.append(time)
            check_image(f"{name}.vtkhdf step {step}", output, cells_along_z, step)
        same(f"{name}.vtkhdf times", seen, [0.0, 0.5, 1.0, 1.5])


def main():
    folder = Path(sys.argv[1])
    check_table(folder)
    check_points(folder)
    check_empty(folder)
    check_images(folder)
    with_hdf = (folder / "points.vtkhdf").exists() or "--hdf5" in sys.argv
    if with_hdf:
        check_hdf(folder)
    print("all files read back" + ("" if with_hdf else "; no .vtkhdf files were there"))


if __name__ == "__main__":
    main()
