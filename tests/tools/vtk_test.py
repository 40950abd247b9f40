#!/usr/bin/env python3
"""VTK's readers against each other and against the baked points: vtk_test.py FOLDER."""

import glob
import struct
import sys

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkFeatureEdges, vtkMassProperties
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
from vtkmodules.vtkIOGeometry import vtkOBJReader
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

FOLDER = sys.argv[1]


def read(reader, path):
  faults = []
  reader.AddObserver("ErrorEvent", lambda *_: faults.append(path))
  reader.SetFileName(path)
  reader.Update()
  assert not faults, faults
  output = reader.GetOutput()
  assert output.GetNumberOfPoints() > 0 and output.GetNumberOfCells() > 0, path
  return output


def points(data):
  return vtk_to_numpy(data.GetPoints().GetData())


def names(attributes):
  return {attributes.GetArrayName(i) for i in range(attributes.GetNumberOfArrays())}


def polygons(grid):
  # A plain copy: the filter must neither merge points nor drop faces that coincide.
  surface = vtkGeometryFilter()
  surface.MergingOff()
  surface.SetInputData(grid)
  surface.Update()
  return surface.GetOutput()


def open_edges(surface):
  edges = vtkFeatureEdges()
  edges.SetInputData(surface)
  edges.FeatureEdgesOff()
  edges.ManifoldEdgesOff()
  edges.Update()
  return edges.GetOutput().GetNumberOfCells()


surfaces = sorted(glob.glob(FOLDER + "/vtu/*.vtu"))
volumes = sorted(glob.glob(FOLDER + "/vtu-volume/*.vtu"))
assert len(surfaces) == len(volumes) == 49, (len(surfaces), len(volumes))
for surface_path, volume_path in zip(surfaces, volumes):
  grid = read(vtkXMLUnstructuredGridReader(), surface_path)
  assert {"piece", "id", "rest", "displacement", "velocity", "strain", "damage"} <= \
      names(grid.GetPointData())
  assert {"piece", "id", "region", "inside", "tet", "source"} <= names(grid.GetCellData())
  surface = polygons(grid)
  assert surface.GetNumberOfCells() == grid.GetNumberOfCells()
  assert open_edges(surface) == 0, surface_path
  for kind, reader in (("ply", vtkPLYReader()), ("obj", vtkOBJReader())):
    path = surface_path.replace("/vtu/", f"/{kind}/").replace(".vtu", "." + kind)
    other = read(reader, path)
    assert other.GetNumberOfCells() == grid.GetNumberOfCells(), path
    # VTK's OBJ reader makes a point of each corner that has a normal or texture of its own.
    distinct = np.unique(points(grid), axis=0)
    assert np.array_equal(np.unique(points(other), axis=0), distinct), path
    if kind == "ply":
      assert np.array_equal(points(other), points(grid)), path
  volume = read(vtkXMLUnstructuredGridReader(), volume_path)
  assert {"piece", "region", "strain", "damage", "broken_edges", "separated"} <= names(volume.GetCellData())

# At rest, the surface encloses what the tets fill.
sizes = vtkCellSizeFilter()
sizes.SetInputData(read(vtkXMLUnstructuredGridReader(), volumes[0]))
sizes.Update()
tets = vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume")).sum()
mass = vtkMassProperties()
mass.SetInputData(polygons(read(vtkXMLUnstructuredGridReader(), surfaces[0])))
mass.Update()
assert abs(mass.GetVolume() / tets - 1) < 1e-5, (mass.GetVolume(), tets)

# The bake's last frame is the last surface; copies of points coincide in neither.
with open(FOLDER + "/bake-pc2/cleave.pc2", "rb") as file:
  cache = file.read()
count, frames = struct.unpack_from("<i", cache, 16)[0], struct.unpack_from("<i", cache, 28)[0]
baked = np.frombuffer(cache, "<f4", 3 * count, 32 + 12 * count * (frames - 1)).reshape(-1, 3)
last = points(read(vtkXMLUnstructuredGridReader(), surfaces[-1]))
assert np.array_equal(baked[np.lexsort(baked.T)], last[np.lexsort(last.T)])
print(f"{len(surfaces)} frames, {count} baked points; rest volume {tets:.6g} m^3")
