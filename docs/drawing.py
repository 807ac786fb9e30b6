"""What the scripts that draw the pictures of docs/ share: reading VTU files, views, writing small PNG files. (Debian packages: python3-vtk9, xvfb)"""
import math
import sys

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

COLOUR_STEP = 8  # of 256: coarse colours shrink the file and do not show


def read_mesh(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    if reader.GetErrorCode() or reader.GetOutput().GetNumberOfCells() == 0:
        sys.exit(f"{path}: not a readable VTU")
    return reader.GetOutput()


def patch_markers(grid):
    """[(marker, kind, name)] of the patches that a file of ours names."""
    fields = grid.GetFieldData()
    names = [(fields.GetArrayName(i), int(fields.GetArray(i).GetTuple1(0))) for i in range(fields.GetNumberOfArrays()) if fields.GetArrayName(i).startswith("patch:")]
    return sorted((marker, *name.split(":")[1:]) for name, marker in names)


def new_window(size):
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(*size)
    return window


def add_view(window, viewport, actors):
    """A view of the actors on white; viewport = (left, low, right, high) in parts of the window."""
    renderer = vtk.vtkRenderer()
    renderer.SetViewport(*viewport)
    renderer.SetBackground(1, 1, 1)
    for item in actors:
        renderer.AddActor(item)
    window.AddRenderer(renderer)
    return renderer


def look(renderer, position, focus, height):
    """Parallel projection, z up; height = what the view shows from its lower to its upper border."""
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(focus)
    camera.SetPosition(position)
    camera.SetViewUp(0, 0, 1)
    camera.SetParallelScale(0.5 * height)
    renderer.ResetCameraClippingRange()


def towards_eye(azimuth, elevation):
    """From ahead (-x) and starboard, above; degrees."""
    a, e = math.radians(azimuth), math.radians(elevation)
    return np.array([-math.cos(a) * math.cos(e), math.sin(a) * math.cos(e), math.sin(e)])


def look_at_all(renderer, points, azimuth, elevation, aspect, margin=0.06):
    """All of the points in a view of this width over height."""
    towards = towards_eye(azimuth, elevation)
    right = np.cross([0.0, 0.0, 1.0], towards)
    right /= np.linalg.norm(right)
    up = np.cross(towards, right)
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    across, high = (points - middle) @ right, (points - middle) @ up
    focus = middle + 0.5 * (across.max() + across.min()) * right + 0.5 * (high.max() + high.min()) * up
    distance = 10.0 * np.linalg.norm(points.max(axis=0) - points.min(axis=0))
    look(renderer, focus + distance * towards, focus, (1.0 + margin) * max(high.max() - high.min(), (across.max() - across.min()) / aspect))


def write_picture(window, path):
    window.Render()
    shot = vtk.vtkWindowToImageFilter()
    shot.SetInput(window)
    shot.ReadFrontBufferOff()
    shot.Update()
    image = shot.GetOutput()
    pixels = vtk_to_numpy(image.GetPointData().GetScalars())
    image.GetPointData().SetScalars(numpy_to_vtk(np.where(pixels >= 252, 255, pixels // COLOUR_STEP * COLOUR_STEP).astype(np.uint8), deep=True))
    writer = vtk.vtkPNGWriter()
    writer.SetInputData(image)
    writer.SetFileName(path)
    writer.SetCompressionLevel(9)
    writer.Write()
