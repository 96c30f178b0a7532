"""Reads a run of the column scene as a user would: pandas for the table, VTK for the fields.

Usage: read_run.py RUN_FOLDER. Exits non-zero when something is not as the run says.
"""

import json
import pathlib
import sys
import xml.etree.ElementTree as xml

import numpy as np
import pandas as pd
import vtk
from vtk.util.numpy_support import vtk_to_numpy

folder = pathlib.Path(sys.argv[1])
facts = json.loads((folder / "run.json").read_text())
assert facts["exit"] == "done", facts["exit"]

series = pd.read_csv(folder / "series.csv")
assert series.columns[0] == "time [s]" and series["time [s]"].is_monotonic_increasing
assert np.isfinite(series.to_numpy()).all()
assert abs(series["front [m]"].iloc[-1] - facts["metrics"]["front"]) < 1e-15
potential = series["potential_energy [J]"].iloc[0]
assert abs(series["energy_residual [J]"]).max() < 1e-3 * potential


def files(collection):
    return [entry.attrib["file"] for entry in xml.parse(folder / collection).getroot().iter("DataSet")]


def read(name):
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(folder / name))
    reader.Update()
    return reader.GetOutput()


frames = files("grains.pvd")
assert len(frames) > 2
grains = read(frames[-1])
radius, speed, velocity = (
    vtk_to_numpy(grains.GetPointData().GetArray(name)) for name in ["radius", "speed", "velocity"]
)
assert grains.GetNumberOfPoints() == grains.GetNumberOfVerts() == len(radius) == 300
assert (radius > 0.46e-3 - 1e-12).all() and (radius < 0.69e-3 + 1e-12).all()
assert np.allclose(np.linalg.norm(velocity, axis=1), speed, rtol=1e-14)

contacts = read(files("contacts.pvd")[-1])
force = vtk_to_numpy(contacts.GetCellData().GetArray("normal_force"))
assert contacts.GetNumberOfLines() == len(force) > 100 and (force >= 0).all()
for figure in ["runout", "energies", "flow", "force_chains"]:
    for ending in ["svg", "png"]:
        assert (folder / f"{figure}.{ending}").stat().st_size > 1000
print(f"read {len(series)} rows, {len(frames)} frames, {len(force)} contacts: all as the run says")
