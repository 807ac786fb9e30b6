"""Reads CAD files with gmsh and prints a line for each behind what OpenCASCADE prints: "result", solids, faces, volume, area (STEP and IGES: in millimetres), names. usage: read_with_gmsh.py FILE ...
Exit status 77 without gmsh."""
import sys

try:
    import gmsh
except ImportError as error:
    print(error)
    sys.exit(77)

gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
gmsh.option.setNumber("Geometry.OCCImportLabels", 1)
for file in sys.argv[1:]:
    gmsh.clear()
    gmsh.model.occ.importShapes(file)
    gmsh.model.occ.synchronize()
    entities = {dim: gmsh.model.getEntities(dim) for dim in (2, 3)}
    sums = {dim: sum(gmsh.model.occ.getMass(*e) for e in entities[dim]) for dim in (2, 3)}
    names = [gmsh.model.getEntityName(*e) for dim in (3, 2) for e in entities[dim]]
    print("result", len(entities[3]), len(entities[2]), repr(sums[3]), repr(sums[2]), "|".join(n for n in names if n))
