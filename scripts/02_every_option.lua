-- Every option of every stage with its default, as a template to copy from. help(read_surface), help(wing) and so on explain each option with its unit and range.
--   ./run scripts/02_every_option.lua

local wall = read_surface{ "data/cessna.msh.gz",
  unit = ft,                        -- length unit of the file: mm, cm, inch, ft or a number of metres; default 1
  split_angle = 60*deg,             -- default: patches as named in the file
  weld_tolerance = "automatic",     -- metres
  fluid = "automatic",               -- automatic, outside, inside: side of the outermost surface on which the fluid lies; inside for a tunnel or a complete domain
  allow_open = false,
  check_intersections = true,
  take_boundary = false,            -- true: read the whole boundary of a volume mesh as the surface; false: reject files with a volume mesh
}

-- repair closes, cuts and removes open, crossing, duplicate and folded facets with as few changes as possible. This surface has no such defects and stays unchanged.
-- read_surface{ ..., repair = true } reads and repairs in one step. auto = true repairs only a surface that cannot be meshed, and wraps the surface if repair fails.
wall = repair{ wall,
  gap = 1e-3,                       -- width of the widest seam that is closed; this and the following lengths are in body lengths
  hole = 0.3,                       -- diameter of the largest curved hole that is filled
  flat_hole = 2,                    -- diameter of the largest hole with a flat border that is filled
  hole_edges = 1000,                -- number of edges of the largest hole that is filled
  smallest_part = 1e-3,             -- parts with a smaller box are removed
  sliver = 1e-7,                    -- shorter edges are collapsed in repaired regions
  largest_move = 0.01,              -- largest allowed displacement of retained facets; more is an error
  half = "automatic",               -- plane in which half a model is open: automatic, off, x, y, z
  half_tolerance = 1e-3,            -- largest distance of the open boundary from that plane
  hull = true,                      -- where facets cross, keep only facets that the outer flow reaches
  rounds = 6,                       -- largest number of rounds of cutting and replacing
}

-- remesh makes new triangles on the surface. The rest of this script uses the input triangles. read_surface{ ..., remesh = { max_edge = 0.3 } } reads and remeshes in one step.
print(remesh{ wall,
  max_edge = 0.6,                   -- largest edge length, metres; automatic: a twentieth of the root of the area
  min_edge = 0.05,                  -- metres; automatic: 2 % of max_edge. Curvature does not require edges shorter than this
  curvature_angle = 20*deg,         -- largest angle by which the surface turns along an edge
  chord_error = "automatic",        -- largest distance between the midpoint of an edge and the curved surface, metres; automatic: no limit
  growth = 1.3,                     -- largest ratio of the lengths of consecutive edges
  refinement = 1,                   -- 1.5: the next finer member of a mesh family; also "coarse", "fine"
  narrow = 2,                       -- largest edge length along a narrow strip between sharp edges, in widths of the strip
  gap_cells = 0,                    -- number of edges across a gap; 0: gaps are ignored
  thickness_factor = "automatic",   -- largest edge length relative to the thickness of the part; automatic: no limit
  feature_angle = 40*deg,           -- edges with a larger bend angle are kept
  smooth = true,                    -- true: new vertices on a curved surface through the input vertices; false: on the input triangles
  max_triangles = 100000000,
  sources = { point{ {5, 0, 2}, size = 0.3 } },
  patches = { ["*"] = { max_edge = 0.6 } },
})

-- Narrow crevices and gaps become solid, because a boundary layer has no room in them. This surface has none up to this width, so there is a warning.
print(fill_crevices{ wall,
  width = 1*mm,                     -- largest distance between facing walls that is filled
  angle = 60*deg,                   -- largest angle of fluid between these walls; parallel walls enclose an angle of 0
})

-- With one surface, union only proves that the surface is a solid. Intersecting parts are united by union{ wall, "sting.stl", unit = mm }.
wall = union{ wall,
  remesh = true,                    -- better triangles along the intersection curves
  strip_width = 4,                  -- distance from the curves within which triangles may change, in local edge lengths
  strip_growth = 1.3,               -- growth of edge lengths away from the curves
  deviation = 0.01,                 -- largest distance of remeshed triangles from the input, in local edge lengths
  keep_cavities = false,            -- true: keep cavities that the parts enclose
}

-- wrap encloses a surface with any defects in a closed surface, and prints which openings were closed and which parts were dropped.
local wrapped = wrap{ wall,
  edge = 0.04 * wall.length,        -- edge length of its triangles, metres; default: about 60 000 triangles
  gap = 0.08 * wall.length,         -- width of the widest openings that are closed; default: twice the edge, at least 2 % of the length
  tolerance = 0.004 * wall.length,  -- largest distance from the input; default: a tenth of the edge
  offset = 0.002 * wall.length,     -- distance at which the wrap is made before it is moved onto the input; default: 1/20 of the edge
  features = 40*deg,                -- edges of the input that bend by more stay sharp
  half = "automatic",               -- automatic, never; automatic: a surface that is open in a plane x, y or z = constant is a half model
  max_triangles = 3000000,          -- more triangles are an error
  unit = 1,                         -- length unit of files
  split_angle = "automatic",        -- patches as named in the input
  fluid = "automatic",              -- automatic, outside, inside (a tunnel): side of the surface on which the fluid lies
}
print(wrapped)

-- inspect predicts before meshing which defects volume_mesh rejects and where the layer becomes low. It takes all options of volume_mesh as well.
local pre = inspect{ wall, layers = 30, first_height = 1e-6 * wall.length,
  min_angle = 1*deg,                -- a triangle with a smaller angle is a sliver
  fold_angle = 1*deg,               -- two neighbouring triangles with a smaller angle between them are folded onto each other
  coarse_angle = 30*deg,            -- a smooth surface that turns by more at an edge is too coarse for its curvature
  size_jump = 5,                    -- largest ratio of the mean edge lengths of two neighbouring triangles
  short_edge = 1e-7,                -- shortest permitted edge, in body lengths
  contact = 0.01,                   -- smallest distance between a vertex and an opposite wall, in edge lengths
  visibility_angle = 80*deg,        -- largest angle between the best growth direction at a vertex and the normals of its facets
  lowered_area = 0.05,              -- share of the wall area on which the layer may be lower than 0.9 of its target
  top_ratio = 3,                    -- largest height ratio of the last layer and the tetrahedra above it
  wanted_y_plus = 1,                -- target y+ of the first height; checked if flow = flow{ ... } is given
  base_ratio = 20,                 -- largest ratio of the layer height to the thickness of a blunt base below the layer
  least_length = 1e-3,              -- a shorter body is reported as a probable unit mistake
  largest_length = 1000,            -- a longer body is reported as a probable unit mistake
  max_places = 5,                   -- number of locations listed for each finding
}
print(pre.ok, pre.coverage)

local mesh = volume_mesh{ wall,
  -- Layer options. Each option can be given here or in the table of its stage, below.
  layers = "automatic",               -- automatic: the last cells have at least half the height of a regular tetrahedron on nine tenths of the area
  first_height = 1e-6 * wall.length,  -- or from flow conditions: y_plus{ ... }, see below
  refinement = 1.0,                 -- member of a mesh family: coarse, medium, fine or a number; give surface_mesh the same value
  family_wake = "automatic",        -- automatic, on, off: add wake{ wall } if no source is given; automatic: if refinement is given

  needles = {                          -- sliver triangles of the wall: see docs/needles.md
    split_needles = 5*deg,          -- triangles with a smaller angle are flipped, and split if needle_budget allows; 0: never
    needle_budget = 0.0,            -- largest number of triangles that splitting adds, relative to the triangles of the walls; 0: edges are only flipped
    flip_angle = 1*deg,             -- edges may be flipped if the wall turns by less than this angle
  },
  ridges = {                          -- several normals along sharp convex edges: see docs/ridges.md
    open_ridges = "never",          -- never, always
    open_angle = 100*deg,           -- edges at which the wall turns by more than this angle get several normals
    fan_angle = 30*deg,             -- largest angle between two normals of an edge
  },
  envelope = {
    max_growth = 1.25,
    growth = "uniform",             -- flat cells grow by max_growth on all growth lines; local: each growth line has its own constant ratio
    total_height = "automatic",     -- metres; give it with layers or with max_growth: the other option follows
    solve_for = "none",             -- none, layers, max_growth: option that follows from total_height; none: the option that is not given
    boundary_layer = "automatic",   -- thickness that the layers must cover (gate G12), metres; automatic: total_height, or from the flow of first_height
    max_thickness = "automatic",
    max_relative_height = "automatic",  -- largest ratio of total height to local edge length of the wall; automatic: no limit
    feature_angle = 35*deg,
    height_gradient = 0.35,
    height_sweeps = 20,
    direction_sweeps = 50,
    envelope_sweeps = 5,
    untangle_share = 0.7,
    max_retract_sweeps = 40,
    height_floor = 0.938,         -- lowest height after smoothing, as a share of the target height
    optimiser = "descent",        -- none, descent (built in), mma, ccsaq (NLopt)
    optimiser_evaluations = 30,
    height_weight = 1.0,          -- weight of full height relative to wall-normal growth lines
    top_weight = 0.4,             -- weight of envelope-normal growth lines
    membrane_weight = 1.0,        -- weight of even heights
    barrier_weight = 0.02,        -- weight of the barrier that keeps elements valid
  },
  prisms = {
    wall_perpendicularity = 1.0,
    truncate = "never",
  },
  patches = {                         -- other values for patches with matching names; of two matching patterns the one with more letters applies
    ["*"] = {
      kind = "as_read",               -- wall, slip, symmetry, inflow, outflow, farfield, interface; only walls carry layers
      layers = -1,                    -- number of layers; connected walls get the largest requested number; 0: none; -1: the value for all walls
      first_height = "automatic",     -- automatic, here and below: the value for all walls
      max_growth = "automatic",
      total_height = "automatic",     -- max_growth follows, or layers if max_growth is given
      max_thickness = "automatic",
      blend = "automatic",            -- blending distance from walls with other layer settings, metres; automatic: from the layer height and the edges
      open_ridges = "as_all",         -- as_all, always, never: several normals along edges between such patches; as_all: value of ridges
      truncate = "as_all",            -- as_all, never, auto, always; as_all: value of prisms
    },
  },
  farfield = {                         -- or sphere{ radius = 100 }, box{ {-10, -5, -5}, {20, 5, 5}, edge = 2 }, cylinder{...}, a surface, a file, "none"
    shape = "sphere",               -- automatic, sphere, box, cylinder, surface, none
    radius = 50 * wall.length,      -- of a sphere or a cylinder
    edge = 10 * wall.length,
    center_x = "automatic",         -- centre of a sphere; automatic: centre of the wall's bounding box, in the symmetry plane of a half model
    center_y = "automatic",
    center_z = "automatic",
    from_x = "automatic",           -- corners of a box, or centres of the ends of a cylinder
    from_y = "automatic",
    from_z = "automatic",
    to_x = "automatic",
    to_y = "automatic",
    to_z = "automatic",
    floor = "",                     -- patches of an open floor surface (terrain): the box gets sides that rise from the border of the floor, and a lid
    sides = "",                     -- kinds, names and edge lengths of the sides: "x_min=inflow x_max=outflow,name:exit,edge:0.5 symmetry=slip"
    surface = "",                   -- file of the closed farfield surface, for the shape "surface"
  },
  ends = {                             -- adjacent patches, in which layers end (symmetry planes, slip walls); they are re-meshed around the layers
    ends_growth = 1.3,                 -- largest edge length ratio of neighbouring triangles of these patches
    ends_min_angle = 25*deg,           -- target for the smallest angle of these triangles
    ends_max_triangles = 2e7,          -- largest number of triangles of one patch; more are an error
  },
  size = {
    size_growth = 1.3,                 -- largest ratio of the sizes of neighbouring tetrahedra
    size_max = "automatic",           -- longest edge, metres; automatic: no limit
  },
  sources = {},                        -- regions of smaller tetrahedra: box{ {-1, -2, -1}, {9, 2, 3}, size = 0.05 }, point, line, sphere, cylinder, wake, size_samples
  wakes = {},                          -- wake_sheet{ wing = "main*", length = 2, growth = 1.2, height_growth = 1.2, alpha = 2*deg }, or "auto"
  interfaces = {},                     -- actuator_disc{ name = "prop", center = {-0.4, 0, 0}, axis = {1, 0, 0}, radius = 1.2, inner_radius = 0.25, edge = 0.05 }
  tetrahedra = {
    engine = "automatic",           -- automatic, sterna, hxt, tetgen
    radius_edge = 1.2,              -- TetGen: largest ratio of circumradius to shortest edge
    two_pass = false,               -- TetGen: a coarse mesh defines the sizes of the final mesh
    hxt_improve_below = 0,          -- HXT improves tetrahedra below this quality; 0: none
    max_new_points = "automatic",   -- largest number of new points; more are a failure of the engine; automatic: no limit
    boundary_splits = "ladder",     -- never, ladder, always: TetGen may split triangles of envelope and farfield; ladder: only after other failures
    try_other_engine = true,        -- use another engine after a reproducible failure
    repair_boundary = true,         -- after failures of all engines, lower and smooth the layer around slivers, folds and gaps of its top, then repeat
    fall_back_on_limits = false,    -- use another engine also after a time or memory limit; the manifest then reports "not reproducible"
    memory_limit = 20e9,            -- memory limit of the engine, bytes
    time_limit = "automatic",       -- time limit of the engine, seconds; automatic: in proportion to boundary and sizes
    helper_folder = "",             -- folder of sterna-tet-tetgen and sterna-tet-hxt; empty: the folder of sterna
  },
  improve = {                         -- improves tetrahedra with dihedral angles outside these limits
    improve_min_angle = 12*deg,
    improve_max_angle = 160*deg,
    improve_rounds = 30,            -- largest number of rounds; 0: no improvement
    slide_share = 0.2,              -- share of the layer height by which growth lines may become lower where prisms and tetrahedra do not match; 0: never
  },
  limits = {                          -- a mesh that is predicted to need more is an error before meshing
    max_memory = 20e9,              -- bytes; automatic: free memory
    force = false,                  -- true: mesh in spite of the prediction
  },
}

mesh:check{ intersections = true, quality = true, cell_centred = true, solvers = "automatic", findings_per_kind = 10, strict = false,
  details = false,                                                                                                    -- true: print all gates with their locations
  gates = { orthogonality = { hard = 3*deg, target = 15*deg, usual = 30*deg, share = 0.99 }, face_weight = false },  -- other limits of quality gates; false: no limits
  cells = "every_option.cells.vtu" }                                                                                  -- file with the quality of each cell, as VTK defines it
-- The report page shows the mesh in a browser. A build without the libraries of the page (from npm) prints an error instead.
print(pcall(report, { mesh, "every_option.html", title = "every option", cuts = { "nose", { x = 1 } }, automatic_cuts = true, times = true,
  max_triangles = 250000, max_polygons = 100000 }))
-- mesh:check{ wall = wall } compares the mesh with the model, if the wall was made by surface_mesh; see below.
mesh:write{ "every_option.vtu", numbering = "automatic" }  -- automatic, lines, bandwidth, both: order of nodes and cells in the file
print(string.format("%d prisms, %d tetrahedra, %.1f %% of the area has its full height", mesh.prisms, mesh.tetrahedra, 100 * mesh.coverage))

-- Pictures (docs/draw.md).
draw{ mesh, "every_option.png",
  view = "iso",                     -- iso, front, back, left, right, top, bottom, "225 30" (azimuth and elevation, degrees), "-1,-1,0.5" (direction from the mesh to the viewer)
  color = "skew",                   -- patch, kind, quality, or a quantity such as edge_length or layer_height
  cut = "none",                     -- none, a named location such as "leading edge", { x = 1.2 }, { point = {0, 0, 0}, normal = {0, 1, 0} }
  focus = "automatic",              -- region that fills the picture: { {1, 2, 0}, radius = 0.5 }, or a named location
  patches = "automatic",            -- patterns of patch names; automatic: walls
  projection = "orthographic",      -- orthographic, perspective
  width = 1600, height = 1000,      -- pixels
  edges = true, legend = true,
  range_min = "automatic", range_max = "automatic",  -- values of the first and last colour, in the unit of the quantity
  title = "automatic",              -- automatic, none, or any text
  places = false,                   -- true: mark the worst locations
  unit = 1,                         -- length unit of the file, if a file is given instead of a mesh: mm, cm, inch, ft or a number of metres
}

-- Heights from flow conditions: y_plus{...} is a value of first_height, boundary_layer{...} a value of total_height.
local cruise = flow{ mach = 0.78, altitude = 11000, length = 1.6,
  temperature_offset = 0,           -- temperature difference to the standard atmosphere, kelvin; ISA+15: 15
}                                     -- other options: speed, temperature, pressure, density, viscosity, reynolds
local tunnel_flow = flow{ speed = 60, temperature = 293, pressure = 101325, length = 0.3 }
local water = flow{ speed = 5, density = 1000, viscosity = 1e-3, length = 2 }
print(cruise, tunnel_flow, water, y_plus{ y_plus = 1, reynolds = 5e6, length = 7 })
print(y_plus{ 1, cruise, at = "cell_centre", law = "schlichting" }, boundary_layer{ cruise, factor = 1.3, thickness_law = "fifth_root" })
for _, member in ipairs(family{ levels = 3, factor = 1.5, medium = 2 }) do print(member.name, member.refinement) end

-- Two members of a mesh family are compared with their model and with each other.
local can = cylinder{ {0, 0, 0}, {2, 0, 0}, radius = 0.5, name = "can" }
local members = {}
for level, member in ipairs(family{ levels = 2, medium = 1 }) do
  local skin = surface_mesh{ can, max_edge = 0.3, refinement = member.refinement }
  skin:check{ strict = true }         -- gates G17 and G18: a gate that FAILs is an error
  members[level] = volume_mesh{ skin, layers = 8, first_height = 5e-3, refinement = member.refinement, farfield = sphere{ radius = 10 } }
  members[level]:check{ wall = skin }
end
check_family{ members[1], members[2],  -- from the coarse to the fine mesh
  factor = 1.5,                       -- ratio of edge lengths; automatic: from the requested refinements, else from the mean edges of the walls
  nodes = 0.1,                        -- allowed relative deviation; the same for the options below
  wall_edge = 0.05,
  first_height = 0.02,
  measured_first = 0.05,
  layers = 1,                         -- allowed rounding of the numbers of layers: half a layer in each mesh
  growth = 0.02,
  measured_growth = 0.1,
  tet_growth = 0.02,
  box = 0.01,
  fail = 3,                           -- a deviation of more than this number of tolerances is a FAIL; a smaller one above the tolerance is a warning
  strict = false,
}

mesh:su2_config{ "every_option.cfg", cruise,
  mesh = "every_option.su2",
  solver = "automatic",             -- automatic, EULER, NAVIER_STOKES, RANS
  turbulence = "SA",                -- SA, SST
  wall_functions = "automatic",     -- automatic, yes, no; automatic: yes if the first height corresponds to a y+ above 20
  alpha = 2*deg, beta = 0,
  reference_area = 16, reference_length = 1.6, moment_origin = { 2, 0, 0 },  -- or reference = an aircraft or a wing
  wing = "",                        -- name of the wing of the reference; empty: the largest wing
  half = "automatic",               -- automatic, yes, no: the mesh is a half model
  wall_temperature = "automatic",   -- kelvin; automatic: adiabatic
  monitor = "",                     -- patches whose forces are summed; empty: all walls
  iterations = 5000,
  cfl = 10,                         -- automatic: 10; 5 or 1 if faces of control volumes are nearly parallel to their edges
  restart = false,                  -- true: continue from restart_flow, which an earlier run wrote
  boundaries = {},                  -- values by patch: { prop = { thrust = 800 } }, or pressure_jump = 120, temperature_jump = 0; for inflows and outflows pressure = 1e5, total_pressure = 1.1e5, total_temperature = 300
  kinds = {},                       -- kinds of patches for the solver, instead of those in the mesh: { ["top*"] = "slip" }
}

mesh:foam_case{ "every_option_case", cruise,  -- name of a folder; the options of su2_config apply as well, except mesh, solver, turbulence, wall_functions, cfl and restart
  model = "automatic",              -- automatic, laminar, euler, SpalartAllmaras, kOmegaSST
  steady = true,                    -- false: transient run
  compressible = "automatic",       -- automatic, yes, no; automatic: yes from Mach 0.3 on
  turbulence_intensity = 0.001,     -- turbulence intensity of the free stream (kOmegaSST)
  viscosity_ratio = "automatic",    -- ratio of turbulent to molecular viscosity in the free stream
  residual = "automatic",           -- a steady run ends below this residual; automatic: 1e-6 if there are no forces
  end_time = "automatic",           -- end of a transient run, seconds
  courant = 2,                      -- largest Courant number of a transient run
  tasks = 1,                        -- number of processes
  write_interval = 500,
  format = "binary",                -- binary, text
  numbering = "both",               -- lines, bandwidth, both
  reference_area = 16,
}

-- A half model: volume_mesh{ side, ... } adds half a sphere and the symmetry plane.
local side = half{ wall, axis = "y", at = 0, keep = "+",
  tolerance = "automatic",          -- vertices closer to the plane than this are moved into the plane; automatic: 1e-6 of the longest side
  snap = 0.1,                       -- vertices closer to the plane than this share of their shortest edge are moved along an edge into the plane, which avoids slivers
}

local behind = wake{ {0, 0, 0}, {0, 5, 0}, direction = {1, 0, 0}, length = 10, height = 0, spread = 0, size = 0.1, size_end = 0.1 }   -- an entry of sources, see above
behind = wake{ wall, direction = {1, 0, 0}, length = 2, size = "automatic", size_end = "automatic", spread = 0.05 }   -- the wake of a whole surface; length in body lengths

-- ---- Geometry ----------------------------------------------------------------------------------------------------------------------------

local section = airfoil{ "naca23012",
  trailing_edge = "automatic",        -- thickness, relative to the chord; automatic: unchanged
  points = 0,                         -- number of points along each side; 0: unchanged
  within = "automatic",               -- use the fewest points that stay within this distance, relative to the chord; automatic: unchanged
}

local body = fuselage{
  name = "fuselage",
  symmetric = false,                  -- true: add a mirror image on the other side of y = 0
  position = { 0, 0, 0 },
  along = "monotone",                 -- monotone (never beyond the frames), smooth, akima (straight parts stay straight), linear
  nose = "round", nose_height = 1.0,  -- round, flat; the height is relative to the mean radius
  tail = "round", tail_height = 1.0,
  pitch = 0,
  frames = {
    { x = 0, diameter = 0.5 },
    { x = 3, y = 0, z = 0, width = 2, height = 2, shape = "superellipse", exponent = 2.0 },
    { x = 6, width = 2, height = 2.2, shape = "double_ellipse", offset = 0 },
    { x = 9, width = 2, height = 2, shape = "egg", distortion = 0 },
    { x = 12, diameter = 0.6 } },     -- or points = {{y, z}, ...}: points of the right half from the bottom to the top
}

local main_wing = wing{
  name = "wing",
  symmetric = true,
  position = { 4, 0, -0.4 },
  spanwise = "linear",                -- linear, cubic
  sweep_at = 0.25,                    -- fraction of the chord at which the sweep is measured
  incidence = 0,
  trailing_edge = "automatic",        -- thickness of the trailing edge, metres; 0: sharp; automatic: as in the airfoils
  tip = "round", tip_height = 1.0,    -- round, flat
  root = "flat",
  sections = {
    { x = 0, y = 0, z = 0, chord = 3, airfoil = section, twist = 0, roll = "automatic", is_break = false, is_reversed = false },
    { span = 5, chord = 1.5, sweep = 0, dihedral = 0 } },
  winglet = { height = 0.6, cant = 80*deg, taper = 0.4, sweep = 35*deg, toe = 0, bend = 0.3 },
}
main_wing:control{ "flap", from = { 0.15, 0.75 }, to = { 0.5, 0.75 },
  kind = "trailing_edge",             -- trailing_edge, leading_edge, all_moving
  other_side = "same",                -- same, opposite (ailerons), none
}
main_wing:deflect{ "aileron", hinge = { { 0.6, 0.75 }, { 0.8, 0.75 } }, angle = 5*deg,   -- fractions of span and chord of two hinge points, instead of from and to
  gap = "sealed",                     -- sealed, open
  fairing = "automatic",              -- length over which the deflection fades to zero, metres; automatic: a tenth of the mean chord
  other_side = "opposite",
}

local engine = nacelle{ name = "engine", symmetric = true, position = { 3.6, 2, -1 }, length = 2, diameter = 1,
  highlight_ratio = 0.82, fan_ratio = 0.78, fan_depth = 0.25, exit_ratio = 0.6, thickest = 0.35,
  intake = "", exhaust = "",          -- names of the patches of fan face and nozzle; empty: the patch of the nacelle
}
local carrier = pylon{ main_wing, engine, name = "pylon", thickness = 0.1, nacelle_from = 0.2, nacelle_to = 0.95, wing_from = 0.1, wing_to = 0.7 }
local rod = boom{ name = "boom", symmetric = false, from = { 11, 0, 0 }, to = { 16, 0, 0.3 }, diameter = 0.4, nose_length = "automatic", tail_length = "automatic" }
local bulge = fairing{ name = "fairing", position = { 4, 0, -0.8 }, length = 4, width = 1.6, height = 0.8, thickest = 0.4, exponent = 2.5 }
local tank = body_of_revolution{ name = "tank", symmetric = true, position = { 5, 5, -1 }, profile = { {0, 0}, {0.5, 0.2}, {2, 0.2}, {3, 0} }, straight = false }
local support = sting{ name = "sting", from = { 15.5, 0, 0.3 }, to = { 20, 0, 0.3 }, diameter = 0.2, cone_start = "automatic", end_diameter = "automatic" }

local parts = aircraft{ body, main_wing, engine, carrier, rod, bulge, tank, support, name = "aircraft",
  unite = false,                      -- default true: the parts are united to one closed surface
  tolerance = "automatic",            -- tolerance of the union, metres; automatic: increased from 0 to 1e-4 of the longest side until the union is valid
  time_limit = 600,                   -- time limit of each attempt, seconds
}

local sheet = surface{ function(u, v) return u, v, 0.1*u*v end, u = { 0, 1 }, v = { 0, 1 }, name = "surface",
  tolerance = 1e-5,                   -- largest distance between function and spline, metres
  periodic_u = false, periodic_v = false,
  breaks_u = {}, breaks_v = {},       -- parameters at which the function has a kink
  max_intervals = 400,
}
local block, rod_model = box{ {0, 0, 0}, {1, 1, 1}, name = "box" }, cylinder{ {0, 0, 0}, {1, 0, 0}, radius = 0.2, name = "cylinder" }
local tunnel = test_section{ length = 60, width = 20, height = 15,
  upstream = "automatic",             -- length upstream of x = 0, metres; automatic: half the length
  contraction_length = 0, contraction_ratio = 1, diffuser_length = 0, diffuser_angle = 0,
  inflow = "inflow", outflow = "outflow", wall = "tunnel",
  through = {},                       -- names of components or faces that may pass through the walls of the tunnel, such as stings: { "strut*" }
  position = { 0, 0, 0 },             -- position of the model; a round section has a diameter instead of width and height
  max_edge = 2,                       -- longest edge on all patches, metres; automatic: a twelfth of the shortest side
  walls = { kind = "wall", max_edge = 3, -- options of all walls: kind, sizes, and a layer, which volume_mesh takes from here
    layers = 20, first_height = 20e-6, max_growth = 1.3, max_thickness = 0.2, blend = 0.5 },
  ceiling = "slip",                   -- one wall: floor, ceiling, left, right
  patches = { inflow = { max_edge = 4 } },
}
local half_block = half{ box{ {0, -1, 0}, {1, 1, 1} },
  axis = "y", at = 0,                 -- the plane y = 0
  keep = "+",                         -- kept side: "+" is y > 0, "-" is y < 0
  tolerance = "automatic",            -- geometry closer to the plane than this counts as in the plane; automatic: 1e-6 of the longest side
  time_limit = 600,
}

local moved = parts:move{ 0, 0, 0.5 }:rotate{ about = { 5, 0, 0 }, pitch = 0, yaw = 0, roll = 0 }:rotate{ axis = { 0, 0, 1 }, angle = 0 }
  :scale{ factor = 1, about = { 0, 0, 0 } }:mirror{ normal = { 0, 1, 0 }, at = { 0, 0, 0 } }
local bent = moved:deform{ function(x, y, z) return 0, 0, 1e-3*y^2 end,
  tolerance = "automatic",            -- largest distance between function and spline; automatic: 1e-6 of the longest side
  max_samples = 200000,
}
bent = bent:deform{ { {0, 0, 0, 0, 0, 0}, {10, 0, 0, 0, 0, 0}, {5, 6, 0, 0, 0, 0.01}, {5, -6, 0, 0, 0, 0.01}, {5, 0, 3, 0, 0, 0} },
  kernel = "thin_plate",              -- thin_plate, wendland_c2
  radius = "automatic", linear_part = true,
}
block:write{ "every_option.step",
  step_schema = "ap214",              -- ap203, ap214, ap242
  tolerance = "automatic",            -- largest distance of splines from the deformed surfaces; automatic: 1e-6 of the longest side
}
local again = read_cad{ "every_option.step", unit = "automatic", heal = true, cap = false, sew_tolerance = "automatic", small = "automatic", time_limit = 600,
  sheets = "automatic",               -- open shells and loose faces beside closed solids: keep, drop, or patterns of names to leave out: "sketch*, plane 1"
  fluid = "automatic",                -- automatic, outside, inside; inside: closed solids are ducts or complete domains
}
-- Control surfaces of sumo and CPACS files are deflected when the file is read, or later: by an angle, or by a table with the options of wing:deflect{}.
local fin = wing{ name = "fin", trailing_edge = 0, sections = { { chord = 2, airfoil = "naca0012" }, { z = 2, chord = 1 } } }
fin:control{ "rudder", from = {0.2, 0.7}, to = {0.9, 0.7} }
aircraft{ fin, unite = false }:write "every_option.smx"
local rudder = read_smx{ "every_option.smx", deflections = { rudder = { angle = 10*deg, gap = "sealed", fairing = "automatic", other_side = "none" } } }
print(rudder, rudder:deflect{ ["rud*"] = -5*deg })
print(parts, bent, sheet, again, union{ block, rod_model, tolerance = "automatic", time_limit = 600 }, assembly{ block, tunnel, unite = true }, half_block)

-- surface_mesh meshes the faces of a model with triangles, as input of volume_mesh. Several models are meshed side by side.
local skin = surface_mesh{ block,
  max_edge = "automatic",             -- largest edge length, metres; automatic: 8 % of the mean circumference of bodies, 15 % of the mean chord of wings
  min_edge = "automatic",             -- smallest edge length that curvature may require, metres; automatic: 2 % of the longest edge
  curvature_angle = 12*deg,           -- largest angle by which the surface turns along an edge
  chord_error = "automatic",          -- largest distance between the middle of a triangle and the surface, metres; automatic: no limit
  growth = 1.2,
  refinement = 1.0,                   -- 1.5: the next finer mesh of a family
  narrow = 2.0,                       -- largest edge length along a narrow face, in widths of the face
  leading_edge_factor = 0.5,          -- edge length at leading edges of wings made of sections, relative to the longest edge
  trailing_edge_factor = 0.5,
  tip_strips = true,                  -- 0.4 and 0.6 of the longest edge near the tips of wings
  intersection_factor = 0.5,          -- edge length where components of a union meet, relative to the longest edge
  gap_cells = 0,                      -- number of edges across a gap; 0: gaps are ignored
  thickness_factor = "automatic",     -- largest edge length relative to the thickness of the part; automatic: no limit
  sources = { line{ {0, 0, 0}, {0.5, 0, 0}, size = 0.05, radius = 0.1 } },
  size = function(x, y, z) return 0.2 end,  -- largest edge length by location, metres
  failed_faces = "error",             -- error, hole: a face that cannot be meshed is an error, or is left as a hole with a warning
  crossings = "error",                -- error, warn, ignore: crossings that remain after refinement are an error or a warning; ignore: no test for crossings
  max_triangles = 100000000,
  -- Rows of stretched triangles along leading and trailing edges of wings. This box has none. The options can also be given in tables: leading_edge = { chordwise = 0.004, stretch = 8 }.
  leading_edge_chordwise = "automatic",   -- height of the first cell, metres; automatic: no rows, or the longest edge divided by the stretch
  leading_edge_stretch = "automatic",     -- ratio of the longest cell along the edge to the first cell across it, up to 50; automatic: no rows, or 10
  leading_edge_growth = 1.2,
  trailing_edge_chordwise = "automatic",
  trailing_edge_stretch = "automatic",
  trailing_edge_growth = 1.2,
  trailing_edge_cells = "automatic",      -- number of cells across the base of blunt trailing edges
  patches = {                         -- options of faces with matching names; of two matching patterns the one with more letters applies
    ["box*"] = { max_edge = 0.1, min_edge = "automatic", curvature_angle = "automatic", chord_error = "automatic",
      leading_edge_factor = "automatic", trailing_edge_factor = "automatic",
      leading_edge = { chordwise = "automatic", stretch = "automatic", growth = "automatic" }, trailing_edge = { chordwise = "automatic", stretch = "automatic", growth = "automatic", cells = "automatic" } } },
}
print(skin)

-- A periodic row of bodies: two sides of the tunnel have identical nodes, shifted by the width of the tunnel.
local stub = cylinder{ {-0.4, 0, 0}, {0.4, 0, 0}, radius = 0.3, name = "stub" }
local row = test_section{ length = 4, width = 2, height = 2, walls = "slip", max_edge = 0.5 }
print(volume_mesh{ surface_mesh{ stub, row, max_edge = 0.3, growth = 1.4, periodic = { { "tunnel_left", "tunnel_right" } } }, layers = 4, first_height = 2e-3, periodic = { { "tunnel_left", "tunnel_right" } } })

-- A series of cases. Each case runs in a separate process and folder.
local here = jobs{ tasks = 2, threads = 1 }
local cluster = slurm{ partition = "cfd", tasks = 64, threads = 2, time = "02:00:00" }   -- for use as run = cluster
local heights = series{ "heights", over = { height = { 0.5, 1.0 } }, run = here, cache = false, retry = false,  -- retry: true repeats cases that failed
  case = function(p) return surface_mesh{ box{ {0, 0, 0}, {1, 1, p.height} }, max_edge = 0.5 }:write "box.stl".triangles end }
print(heights.done, heights.failed)
