"""What the scripts that read files with other programs' readers share."""
import sys
import warnings

K_MISSING = 77  # exit status: the Python module is not installed


def module(*names):
    """The modules of these names, or the end with K_MISSING."""
    warnings.filterwarnings("ignore")
    try:
        return [__import__(name, fromlist=["_"]) for name in names]
    except ImportError as failure:
        print(failure)
        sys.exit(K_MISSING)


GMSH_NAMES = {2: "triangle", 3: "quad", 4: "tetra", 5: "hexahedron", 6: "wedge", 7: "pyramid"}


def read_with_gmsh(path):
    """points, kind -> node numbers, kind -> physical group (or else entity) of each cell. Any error or warning of Gmsh's is the end."""
    np, gmsh = module("numpy", "gmsh")
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.logger.start()
    gmsh.open(path)
    complaints = [line for line in gmsh.logger.get() if line.startswith(("Warning", "Error"))]
    if complaints:
        sys.exit("gmsh: " + "; ".join(complaints))
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    order = np.argsort(tags)
    points = np.asarray(coordinates).reshape(-1, 3)[order]
    blocks, markers = {}, {}
    for dimension, entity in gmsh.model.getEntities():
        groups = gmsh.model.getPhysicalGroupsForEntity(dimension, entity)
        marker = abs(int(groups[0])) if len(groups) else entity
        for kind, elements, nodes in zip(*gmsh.model.mesh.getElements(dimension, entity)):
            if kind not in GMSH_NAMES:
                continue
            name = GMSH_NAMES[kind]
            cells = np.searchsorted(np.asarray(tags)[order], np.asarray(nodes)).reshape(len(elements), -1)
            numbers = np.full(len(elements), marker)
            blocks[name] = np.concatenate([blocks[name], cells]) if name in blocks else cells
            markers[name] = np.concatenate([markers[name], numbers]) if name in markers else numbers
    return points, blocks, markers
