-- Every option of every stage at its default, to copy from. help(read_surface), help(wing) and so on say what each one does, its unit and its range.
--   ./run scripts/02_every_option.lua

local wall = read_surface{ "data/cessna.msh.gz",
  unit = ft,                        -- metres per unit of the file: mm, cm, inch, ft or a number; default 1
  split_angle = 60*deg,             -- default: patches as the file names them
  weld_tolerance = "automatic",     -- metres
  fluid = "automatic",               -- or outside, inside: of the outermost surface (a tunnel, a complete domain)
  allow_open = false,
  check_intersections = true,
  take_boundary = false,            -- true: a volume mesh gives all of its boundary; else it is refused
}

-- What is open, crossing, doubled or folded becomes a surface that can be meshed, with as few changes as possible; this one is sound and stays as it is.
-- read_surface{ ..., repair = true } does it at once, auto = true only where it has to be done, and wraps where that is not enough.
wall = repair{ wall,
  gap = 1e-3,                       -- widest seam that is zipped, in body lengths, as all of these
  hole = 0.3,                       -- diameter of the largest curved hole that is filled
  flat_hole = 2,                    -- the same of holes with a flat rim
  hole_edges = 1000,                -- edges of the largest hole
  smallest_part = 1e-3,             -- smaller parts are dropped
  sliver = 1e-7,                    -- shorter edges are collapsed where something was changed
  largest_move = 0.01,              -- more is an error
  half = "automatic",               -- plane in which half a model is open: automatic, off, x, y, z
  half_tolerance = 1e-3,            -- how far off its plane the rim may lie
  hull = true,                      -- of what crosses keep only what the outer flow reaches
  rounds = 6,                       -- of cutting, at most
}

-- New triangles, as of CAD; the rest of this script goes on with the given ones. read_surface{ ..., remesh = { max_edge = 0.3 } } does it at once.
print(remesh{ wall,
  max_edge = 0.6,                   -- metres; automatic: a twentieth of the root of the area
  min_edge = 0.05,                  -- metres; automatic: 2 % of the longest edge. curvature asks for no shorter ones
  curvature_angle = 20*deg,         -- an edge spans at most so much of the surface
  chord_error = "automatic",        -- metres: middles of edges from the surface; automatic: no limit
  growth = 1.3,                     -- of edges that follow each other
  refinement = 1,                   -- 1.5: the next finer one of a family; also "coarse", "fine"
  narrow = 2,                       -- edges along strips between sharp edges, in widths
  gap_cells = 0,                    -- edges across gaps; 0: gaps are not looked for
  thickness_factor = "automatic",   -- edges, in thicknesses of the part; automatic: no limit
  feature_angle = 40*deg,           -- edges that bend by more stay
  smooth = true,                    -- curved between the given vertices; false: on the given triangles
  max_triangles = 100000000,
  sources = { point{ {5, 0, 2}, size = 0.3 } },
  patches = { ["*"] = { max_edge = 0.6 } },
})

-- Narrow crevices and gaps become solid, because no boundary layer has room there. This surface has none up to this width, which is a warning.
print(fill_crevices{ wall,
  width = 1*mm,                     -- largest distance between facing walls that is filled
  angle = 60*deg,                   -- largest angle of fluid between them; parallel walls enclose 0
})

-- Of one surface alone union only proves that it is a solid; here stand the parts that stick in each other: union{ wall, "sting.stl", unit = mm }.
wall = union{ wall,
  remesh = true,                    -- better triangles along the curves in which parts cross
  strip_width = 4,                  -- so far from the curves, in local edge lengths
  strip_growth = 1.3,               -- of edge lengths away from the curves
  deviation = 0.01,                 -- from the input, in local edge lengths
  keep_cavities = false,            -- hollows that the parts enclose
}

-- A surface however torn, wrapped in one that is closed; what it closed and dropped is printed.
local wrapped = wrap{ wall,
  edge = 0.04 * wall.length,        -- of its triangles, metres; default: about 60 000 of them
  gap = 0.08 * wall.length,         -- openings up to this are closed; default: twice the edge, at least 2 % of the length
  tolerance = 0.004 * wall.length,  -- from the input; default: a tenth of the edge
  offset = 0.002 * wall.length,     -- at which it is made before it is brought back; default: 1/20 of the edge
  features = 40*deg,                -- edges that bend by more stay sharp
  half = "automatic",               -- or never: an opening in a plane x, y or z = constant makes half a model
  max_triangles = 3000000,          -- more are refused
  unit = 1,                         -- of files
  split_angle = "automatic",        -- patches as the input names them
  fluid = "automatic",              -- or outside, inside (a tunnel)
}
print(wrapped)

-- Before anything is meshed: what volume_mesh will refuse, where layers get low. Takes what volume_mesh takes, too.
local pre = inspect{ wall, layers = 30, first_height = 1e-6 * wall.length,
  min_angle = 1*deg,                -- from here on something is told: needles
  fold_angle = 1*deg,               -- neighbours folded onto each other
  coarse_angle = 30*deg,            -- bends of smooth surfaces
  size_jump = 5,                    -- of neighbours
  short_edge = 1e-7,                -- over the body length
  contact = 0.01,                   -- distance to another wall, in edges
  visibility_angle = 80*deg,        -- between the best direction and a facet
  lowered_area = 0.05,              -- share of the wall
  top_ratio = 3,                    -- last layer over the tetrahedra above it
  wanted_y_plus = 1,                -- with flow = flow{ ... }
  base_ratio = 20,
  least_length = 1e-3,              -- shorter bodies are reported as a probable unit mistake
  largest_length = 1000,
  max_places = 5,                   -- locations listed for each finding
}
print(pre.ok, pre.coverage)

local mesh = volume_mesh{ wall,
  -- Layer options; options can be given here or in the table of their stage, below.
  layers = "automatic",               -- last cells of at least half the height of a regular tetrahedron on nine tenths of the area
  first_height = 1e-6 * wall.length,  -- or from flow conditions: y_plus{ ... }, below
  refinement = 1.0,                 -- member of a mesh family: coarse, medium, fine or a number; the same for surface_mesh
  family_wake = "automatic",        -- adds wake{ wall } if no source is given; automatic: if refinement is given; on, off

  needles = {                          -- sliver triangles of the wall: see docs/needles.md
    split_needles = 5*deg,          -- triangles with a smaller angle are flipped and split; 0: never
    needle_budget = 0.0,            -- largest number of triangles that splitting adds, relative to the walls; 0: flips only
    flip_angle = 1*deg,             -- edges may be flipped if the wall turns by less than this angle
  },
  ridges = {                          -- several normals along sharp convex edges: see docs/ridges.md
    open_ridges = "never",          -- or always
    open_angle = 100*deg,           -- edges at which the wall turns by more than this angle
    fan_angle = 30*deg,             -- largest angle between two normals of an edge
  },
  envelope = {
    max_growth = 1.25,
    growth = "uniform",             -- flat cells grow by max_growth on all growth lines; local: each growth line has its own constant ratio
    total_height = "automatic",     -- metres; give it with layers or with max_growth: the other option follows
    solve_for = "none",             -- layers, max_growth: the option that follows from total_height; by default the one that is not given
    boundary_layer = "automatic",   -- metres that the layers must cover (gate G12); automatic: total_height, or from the flow of first_height
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
  patches = {                         -- other values for patches with such names; of two matching patterns the one with more letters counts
    ["*"] = {
      kind = "as_read",               -- wall, slip, symmetry, inflow, outflow, farfield, interface; only walls carry layers
      layers = -1,                    -- connected walls get the largest requested number; 0: none; -1: as above
      first_height = "automatic",     -- here and below: as above
      max_growth = "automatic",
      total_height = "automatic",     -- max_growth follows, or layers if max_growth is given
      max_thickness = "automatic",
      blend = "automatic",            -- blending distance (metres) from walls with other layer settings; automatic: from layers and edges
      open_ridges = "as_all",         -- as_all: value of ridges; always, never: edges between such patches
      truncate = "as_all",            -- as_all: value of prisms; never, auto, always
    },
  },
  farfield = {                         -- or sphere{ radius = 100 }, box{ {-10, -5, -5}, {20, 5, 5}, edge = 2 }, cylinder{...}, a surface, a file, "none"
    shape = "sphere",               -- automatic, sphere, box, cylinder, surface, none
    radius = 50 * wall.length,      -- sphere, cylinder
    edge = 10 * wall.length,
    center_x = "automatic",         -- sphere: centre of the wall's bounding box, in the symmetry plane of a half model
    center_y = "automatic",
    center_z = "automatic",
    from_x = "automatic",           -- box: corners; cylinder: centres of the ends
    from_y = "automatic",
    from_z = "automatic",
    to_x = "automatic",
    to_y = "automatic",
    to_z = "automatic",
    floor = "",                     -- patches of an open floor surface (terrain): the box gets sides upwards from its border, and a lid
    sides = "",                     -- "x_min=inflow x_max=outflow,name:exit,edge:0.5 symmetry=slip"
    surface = "",                   -- file of the closed farfield surface, for the shape "surface"
  },
  ends = {                             -- adjacent patches (where layers end: symmetry planes, slip walls), re-meshed around the layers
    ends_growth = 1.3,                 -- edge length ratio of neighbouring triangles, with distance from the layer
    ends_min_angle = 25*deg,           -- target of their smallest angle
    ends_max_triangles = 2e7,          -- of one patch; more triangles are an error
  },
  size = {
    size_growth = 1.3,                 -- largest ratio of the sizes of neighbouring tetrahedra
    size_max = "automatic",           -- longest edge; automatic: no limit
  },
  sources = {},                        -- smaller tetrahedra: box{ {-1, -2, -1}, {9, 2, 3}, size = 0.05 }, point, line, sphere, cylinder, wake, size_samples
  wakes = {},                          -- wake_sheet{ wing = "main*", length = 2, growth = 1.2, height_growth = 1.2, alpha = 2*deg }, or "auto"
  interfaces = {},                     -- actuator_disc{ name = "prop", center = {-0.4, 0, 0}, axis = {1, 0, 0}, radius = 1.2, inner_radius = 0.25, edge = 0.05 }
  tetrahedra = {
    engine = "automatic",           -- or "sterna", "hxt", "tetgen"
    radius_edge = 1.2,              -- TetGen
    two_pass = false,               -- TetGen: a coarse mesh gives the sizes of the final mesh
    hxt_improve_below = 0,          -- HXT's own improvement; 0: none
    max_new_points = "automatic",   -- more are a failure; automatic: no limit
    boundary_splits = "ladder",     -- never, ladder, always: whether TetGen may split triangles of envelope and farfield; ladder: after other failures
    try_other_engine = true,        -- after a reproducible failure
    repair_boundary = true,         -- after all failures: lowers and smooths the layer around slivers, folds and gaps of its top, then tries again
    fall_back_on_limits = false,    -- also after a time or memory limit; the manifest then says "not reproducible"
    memory_limit = 20e9,            -- bytes; limit of the engine
    time_limit = "automatic",       -- seconds; automatic: in proportion to boundary and sizes
    helper_folder = "",             -- folder of sterna-tet-tetgen and sterna-tet-hxt; empty: the folder of sterna
  },
  improve = {                         -- improves tetrahedra with dihedral angles beyond these
    improve_min_angle = 12*deg,
    improve_max_angle = 160*deg,
    improve_rounds = 30,            -- 0: none
    slide_share = 0.2,              -- share of the layer height by which growth lines may become lower where prisms and tetrahedra do not match; 0: never
  },
  limits = {                          -- if the mesh is expected to need more, the run ends with an error before meshing
    max_memory = 20e9,              -- bytes; automatic: free memory
    force = false,                  -- continue anyway
  },
}

mesh:check{ intersections = true, quality = true, cell_centred = true, solvers = "automatic", findings_per_kind = 10, strict = false,
  details = false,                                                                                                    -- true: all gates with their places
  gates = { orthogonality = { hard = 3*deg, target = 15*deg, usual = 30*deg, share = 0.99 }, face_weight = false },  -- other limits of quality; false: none
  cells = "every_option.cells.vtu" }                                                                                  -- quality of each cell, as VTK has it
-- A page that shows it all; a build that could not get the page's libraries from npm says so.
print(pcall(report, { mesh, "every_option.html", title = "every option", cuts = { "nose", { x = 1 } }, automatic_cuts = true, times = true,
  max_triangles = 250000, max_polygons = 100000 }))
-- mesh:check{ wall = wall } compares the walls with the model, where wall is of surface_mesh: below.
mesh:write{ "every_option.vtu", numbering = "automatic" }  -- lines, bandwidth, both: order of nodes and cells in the file
print(string.format("%d prisms, %d tetrahedra, %.1f %% of the area has its full height", mesh.prisms, mesh.tetrahedra, 100 * mesh.coverage))

-- Pictures (docs/draw.md).
draw{ mesh, "every_option.png",
  view = "iso",                     -- front, back, left, right, top, bottom, "225 30" (azimuth, elevation), "-1,-1,0.5" (from the mesh to the eye)
  color = "skew",                   -- patch, kind, quality, or a figure: edge_length, layer_height ...
  cut = "none",                     -- "leading edge" ..., { x = 1.2 }, { point = {0, 0, 0}, normal = {0, 1, 0} }
  focus = "automatic",              -- { {1, 2, 0}, radius = 0.5 }, or the name of a place
  patches = "automatic",            -- patterns of names; automatic: walls
  projection = "orthographic",      -- perspective
  width = 1600, height = 1000,      -- pixels
  edges = true, legend = true,
  range_min = "automatic", range_max = "automatic",  -- of the colours, in the figure's unit
  title = "automatic",              -- none, or any text
  places = false,                   -- mark the worst places
  unit = 1,                         -- of a file's name in place of the mesh: mm, inch ...
}

-- Heights from flow conditions: y_plus{...} as a first_height, boundary_layer{...} as a total_height.
local cruise = flow{ mach = 0.78, altitude = 11000, length = 1.6,
  temperature_offset = 0,           -- ISA+15: 15
}                                     -- others: speed, temperature, pressure, density, viscosity, reynolds
local tunnel_flow = flow{ speed = 60, temperature = 293, pressure = 101325, length = 0.3 }
local water = flow{ speed = 5, density = 1000, viscosity = 1e-3, length = 2 }
print(cruise, tunnel_flow, water, y_plus{ y_plus = 1, reynolds = 5e6, length = 7 })
print(y_plus{ 1, cruise, at = "cell_centre", law = "schlichting" }, boundary_layer{ cruise, factor = 1.3, thickness_law = "fifth_root" })
for _, member in ipairs(family{ levels = 3, factor = 1.5, medium = 2 }) do print(member.name, member.refinement) end

-- Two members of a family, compared with their model and with each other.
local can = cylinder{ {0, 0, 0}, {2, 0, 0}, radius = 0.5, name = "can" }
local members = {}
for level, member in ipairs(family{ levels = 2, medium = 1 }) do
  local skin = surface_mesh{ can, max_edge = 0.3, refinement = member.refinement }
  skin:check{ strict = true }         -- G17, G18: a gate that FAILs is an error
  members[level] = volume_mesh{ skin, layers = 8, first_height = 5e-3, refinement = member.refinement, farfield = sphere{ radius = 10 } }
  members[level]:check{ wall = skin }
end
check_family{ members[1], members[2],  -- from coarse to fine
  factor = 1.5,                       -- automatic: of the refinements asked for, else of the wall's edges
  nodes = 0.1,                        -- shares by which each may be off
  wall_edge = 0.05,
  first_height = 0.02,
  measured_first = 0.05,
  layers = 1,                         -- half a layer in each of the two
  growth = 0.02,
  measured_growth = 0.1,
  tet_growth = 0.02,
  box = 0.01,
  fail = 3,                           -- times the tolerance: up to there a rule warns
  strict = false,
}

mesh:su2_config{ "every_option.cfg", cruise,
  mesh = "every_option.su2",
  solver = "automatic",             -- EULER, NAVIER_STOKES, RANS
  turbulence = "SA",                -- SST
  wall_functions = "automatic",     -- yes, no; by itself where the first height means a y+ above 20
  alpha = 2*deg, beta = 0,
  reference_area = 16, reference_length = 1.6, moment_origin = { 2, 0, 0 },  -- or reference = an aircraft or a wing
  wing = "",                        -- of the reference; empty: the largest
  half = "automatic",               -- yes, no
  wall_temperature = "automatic",   -- kelvin; automatic: adiabatic
  monitor = "",                     -- patches whose forces count; empty: walls
  iterations = 5000,
  cfl = 10,                         -- automatic: 10, and 5 or 1 where faces of control volumes lie nearly along their edges
  restart = false,                  -- true: from restart_flow of an earlier run
  boundaries = {},                  -- by patches: { prop = { thrust = 800 } }, or pressure_jump = 120, temperature_jump = 0; of openings pressure = 1e5, total_pressure = 1.1e5, total_temperature = 300
  kinds = {},                       -- what patches are to the solver: { ["top*"] = "slip" }
}

mesh:foam_case{ "every_option_case", cruise,  -- a folder; of the rest of the table: the entries of su2_config but mesh, solver, turbulence, wall_functions, cfl and restart
  model = "automatic",              -- laminar, euler, SpalartAllmaras, kOmegaSST
  steady = true,                    -- false: in time
  compressible = "automatic",       -- yes, no; by itself from Mach 0.3 on
  turbulence_intensity = 0.001,     -- of the free stream (kOmegaSST)
  viscosity_ratio = "automatic",    -- of the free stream
  residual = "automatic",           -- below which a steady run ends: 1e-6 where there are no forces to judge
  end_time = "automatic",           -- seconds, of a run in time
  courant = 2,                      -- of a run in time
  tasks = 1,                        -- processes
  write_interval = 500,
  format = "binary",                -- text
  numbering = "both",               -- lines, bandwidth
  reference_area = 16,
}

-- A half model: volume_mesh{ side, ... } puts half a sphere and the symmetry plane around it.
local side = half{ wall, axis = "y", at = 0, keep = "+",
  tolerance = "automatic",          -- vertices this near are moved into the plane: 1e-6 of the longest side
  snap = 0.1,                       -- those this near, in their shortest edges, are moved along an edge: no slivers
}

local behind = wake{ {0, 0, 0}, {0, 5, 0}, direction = {1, 0, 0}, length = 10, height = 0, spread = 0, size = 0.1, size_end = 0.1 }   -- for sources, above
behind = wake{ wall, direction = {1, 0, 0}, length = 2, size = "automatic", size_end = "automatic", spread = 0.05 }   -- behind a whole surface, in body lengths

-- ---- Geometry ----------------------------------------------------------------------------------------------------------------------------

local section = airfoil{ "naca23012",
  trailing_edge = "automatic",        -- of the chord; automatic: as it is
  points = 0,                         -- along each side; 0: as they are
  within = "automatic",               -- as few points as keep so near, of the chord
}

local body = fuselage{
  name = "fuselage",
  symmetric = false,                  -- a mirror image on the other side of y = 0
  position = { 0, 0, 0 },
  along = "monotone",                 -- monotone (never beyond the frames), smooth, akima (straight parts stay straight), linear
  nose = "round", nose_height = 1.0,  -- or "flat"; of the mean radius
  tail = "round", tail_height = 1.0,
  pitch = 0,
  frames = {
    { x = 0, diameter = 0.5 },
    { x = 3, y = 0, z = 0, width = 2, height = 2, shape = "superellipse", exponent = 2.0 },
    { x = 6, width = 2, height = 2.2, shape = "double_ellipse", offset = 0 },
    { x = 9, width = 2, height = 2, shape = "egg", distortion = 0 },
    { x = 12, diameter = 0.6 } },     -- or points = {{y, z}, ...}: the right half from the bottom to the top
}

local main_wing = wing{
  name = "wing",
  symmetric = true,
  position = { 4, 0, -0.4 },
  spanwise = "linear",                -- or "cubic"
  sweep_at = 0.25,                    -- part of the chord
  incidence = 0,
  trailing_edge = "automatic",        -- metres; 0: sharp; automatic: as the airfoils have it
  tip = "round", tip_height = 1.0,    -- or "flat"
  root = "flat",
  sections = {
    { x = 0, y = 0, z = 0, chord = 3, airfoil = section, twist = 0, roll = "automatic", is_break = false, is_reversed = false },
    { span = 5, chord = 1.5, sweep = 0, dihedral = 0 } },
  winglet = { height = 0.6, cant = 80*deg, taper = 0.4, sweep = 35*deg, toe = 0, bend = 0.3 },
}
main_wing:control{ "flap", from = { 0.15, 0.75 }, to = { 0.5, 0.75 },
  kind = "trailing_edge",             -- leading_edge, all_moving
  other_side = "same",                -- opposite (ailerons), none
}
main_wing:deflect{ "aileron", hinge = { { 0.6, 0.75 }, { 0.8, 0.75 } }, angle = 5*deg,   -- in place of from and to: places of a hinge
  gap = "sealed",                     -- or "open"
  fairing = "automatic",              -- metres; automatic: a tenth of the mean chord
  other_side = "opposite",
}

local engine = nacelle{ name = "engine", symmetric = true, position = { 3.6, 2, -1 }, length = 2, diameter = 1,
  highlight_ratio = 0.82, fan_ratio = 0.78, fan_depth = 0.25, exit_ratio = 0.6, thickest = 0.35,
  intake = "", exhaust = "",          -- names of patches; empty: the nacelle's
}
local carrier = pylon{ main_wing, engine, name = "pylon", thickness = 0.1, nacelle_from = 0.2, nacelle_to = 0.95, wing_from = 0.1, wing_to = 0.7 }
local rod = boom{ name = "boom", symmetric = false, from = { 11, 0, 0 }, to = { 16, 0, 0.3 }, diameter = 0.4, nose_length = "automatic", tail_length = "automatic" }
local bulge = fairing{ name = "fairing", position = { 4, 0, -0.8 }, length = 4, width = 1.6, height = 0.8, thickest = 0.4, exponent = 2.5 }
local tank = body_of_revolution{ name = "tank", symmetric = true, position = { 5, 5, -1 }, profile = { {0, 0}, {0.5, 0.2}, {2, 0.2}, {3, 0} }, straight = false }
local support = sting{ name = "sting", from = { 15.5, 0, 0.3 }, to = { 20, 0, 0.3 }, diameter = 0.2, cone_start = "automatic", end_diameter = "automatic" }

local parts = aircraft{ body, main_wing, engine, carrier, rod, bulge, tank, support, name = "aircraft",
  unite = false,                      -- default true: one closed surface
  tolerance = "automatic",            -- of the union, metres: a ladder from 0 to 1e-4 of the longest side
  time_limit = 600,                   -- seconds, for each try
}

local sheet = surface{ function(u, v) return u, v, 0.1*u*v end, u = { 0, 1 }, v = { 0, 1 }, name = "surface",
  tolerance = 1e-5,                   -- metres between function and spline
  periodic_u = false, periodic_v = false,
  breaks_u = {}, breaks_v = {},       -- where the function has a kink
  max_intervals = 400,
}
local block, rod_model = box{ {0, 0, 0}, {1, 1, 1}, name = "box" }, cylinder{ {0, 0, 0}, {1, 0, 0}, radius = 0.2, name = "cylinder" }
local tunnel = test_section{ length = 60, width = 20, height = 15,
  upstream = "automatic",             -- automatic: half its length before x = 0
  contraction_length = 0, contraction_ratio = 1, diffuser_length = 0, diffuser_angle = 0,
  inflow = "inflow", outflow = "outflow", wall = "tunnel",
  through = {},                       -- names of components or faces that may pass through its walls, as stings may: { "strut*" }
  position = { 0, 0, 0 },             -- where the model stands; a round section has a diameter in place of width and height
  max_edge = 2,                       -- of all patches; automatic: a twelfth of the shortest side
  walls = { kind = "wall", max_edge = 3, -- all walls: kind, sizes, and their own layer, which volume_mesh takes over
    layers = 20, first_height = 20e-6, max_growth = 1.3, max_thickness = 0.2, blend = 0.5 },
  ceiling = "slip",                   -- floor, ceiling, left, right: one of them
  patches = { inflow = { max_edge = 4 } },
}
local half_block = half{ box{ {0, -1, 0}, {1, 1, 1} },
  axis = "y", at = 0,                 -- the plane
  keep = "+",                         -- or "-": the side of smaller y
  tolerance = "automatic",            -- 1e-6 of the longest side: so near to the plane is in it
  time_limit = 600,
}

local moved = parts:move{ 0, 0, 0.5 }:rotate{ about = { 5, 0, 0 }, pitch = 0, yaw = 0, roll = 0 }:rotate{ axis = { 0, 0, 1 }, angle = 0 }
  :scale{ factor = 1, about = { 0, 0, 0 } }:mirror{ normal = { 0, 1, 0 }, at = { 0, 0, 0 } }
local bent = moved:deform{ function(x, y, z) return 0, 0, 1e-3*y^2 end,
  tolerance = "automatic",            -- between function and spline: 1e-6 of the longest side
  max_samples = 200000,
}
bent = bent:deform{ { {0, 0, 0, 0, 0, 0}, {10, 0, 0, 0, 0, 0}, {5, 6, 0, 0, 0, 0.01}, {5, -6, 0, 0, 0, 0.01}, {5, 0, 3, 0, 0, 0} },
  kernel = "thin_plate",              -- or "wendland_c2"
  radius = "automatic", linear_part = true,
}
block:write{ "every_option.step",
  step_schema = "ap214",              -- ap203, ap242
  tolerance = "automatic",            -- of splines in place of deformed surfaces: 1e-6 of the longest side
}
local again = read_cad{ "every_option.step", unit = "automatic", heal = true, cap = false, sew_tolerance = "automatic", small = "automatic", time_limit = 600,
  sheets = "automatic",               -- open shells and loose faces beside closed solids: keep, drop, or patterns of names to leave out: "sketch*, plane 1"
  fluid = "automatic",                -- outside; inside: closed solids are ducts or complete domains
}
-- Control surfaces that files describe (sumo, CPACS) turn as they are read, or later: by an angle, or a table as of wing:deflect{}.
local fin = wing{ name = "fin", trailing_edge = 0, sections = { { chord = 2, airfoil = "naca0012" }, { z = 2, chord = 1 } } }
fin:control{ "rudder", from = {0.2, 0.7}, to = {0.9, 0.7} }
aircraft{ fin, unite = false }:write "every_option.smx"
local rudder = read_smx{ "every_option.smx", deflections = { rudder = { angle = 10*deg, gap = "sealed", fairing = "automatic", other_side = "none" } } }
print(rudder, rudder:deflect{ ["rud*"] = -5*deg })
print(parts, bent, sheet, again, union{ block, rod_model, tolerance = "automatic", time_limit = 600 }, assembly{ block, tunnel, unite = true }, half_block)

-- The faces of a model as triangles: what volume_mesh takes. Several models stand side by side.
local skin = surface_mesh{ block,
  max_edge = "automatic",             -- metres; automatic: 8 % of the mean circumference of bodies, 15 % of the mean chord of wings
  min_edge = "automatic",             -- 2 % of the longest edge
  curvature_angle = 12*deg,           -- an edge spans at most this angle of the surface
  chord_error = "automatic",          -- metres between an edge's middle and the surface; automatic: no limit
  growth = 1.2,
  refinement = 1.0,                   -- 1.5: the next finer mesh of a family
  narrow = 2.0,                       -- edges along narrow faces, of their width
  leading_edge_factor = 0.5,          -- of the longest edge, at leading edges of wings made of sections
  trailing_edge_factor = 0.5,
  tip_strips = true,                  -- 0.4 and 0.6 of the longest edge beside tips of wings
  intersection_factor = 0.5,          -- of the longest edge, where components of a union meet
  gap_cells = 0,                      -- edges that fit across gaps; 0: gaps are not looked for
  thickness_factor = "automatic",     -- edges by the thickness of the part; automatic: no limit
  sources = { line{ {0, 0, 0}, {0.5, 0, 0}, size = 0.05, radius = 0.1 } },
  size = function(x, y, z) return 0.2 end,  -- metres: edges are at most that long
  failed_faces = "error",             -- hole: a face that cannot be meshed is left out, with a warning
  crossings = "error",                -- of triangles that finer ones do not part; warn keeps the mesh, ignore does not look
  max_triangles = 100000000,
  -- Bands of stretched triangles along the edges of wings; a block has none, so nothing is asked for. Also in tables: leading_edge = { chordwise = 0.004, stretch = 8 }.
  leading_edge_chordwise = "automatic",   -- metres, first cell; automatic: no band, or the longest edge by the stretch
  leading_edge_stretch = "automatic",     -- longest cell along : first cell across, up to 50; automatic: no band, or 10
  leading_edge_growth = 1.2,
  trailing_edge_chordwise = "automatic",
  trailing_edge_stretch = "automatic",
  trailing_edge_growth = 1.2,
  trailing_edge_cells = "automatic",      -- across the base of blunt trailing edges
  patches = {                         -- by names of faces; of two patterns that match the one with more letters counts
    ["box*"] = { max_edge = 0.1, min_edge = "automatic", curvature_angle = "automatic", chord_error = "automatic",
      leading_edge_factor = "automatic", trailing_edge_factor = "automatic",
      leading_edge = { chordwise = "automatic", stretch = "automatic", growth = "automatic" }, trailing_edge = { chordwise = "automatic", stretch = "automatic", growth = "automatic", cells = "automatic" } } },
}
print(skin)

-- A row of bodies: two sides of the tunnel are each other's image, node by node.
local stub = cylinder{ {-0.4, 0, 0}, {0.4, 0, 0}, radius = 0.3, name = "stub" }
local row = test_section{ length = 4, width = 2, height = 2, walls = "slip", max_edge = 0.5 }
print(volume_mesh{ surface_mesh{ stub, row, max_edge = 0.3, growth = 1.4, periodic = { { "tunnel_left", "tunnel_right" } } }, layers = 4, first_height = 2e-3, periodic = { { "tunnel_left", "tunnel_right" } } })

-- Cases, each in a process and a folder of its own.
local here = jobs{ tasks = 2, threads = 1 }
local cluster = slurm{ partition = "cfd", tasks = 64, threads = 2, time = "02:00:00" }   -- run = cluster there
local heights = series{ "heights", over = { height = { 0.5, 1.0 } }, run = here, cache = false, retry = false,  -- retry: also cases that failed
  case = function(p) return surface_mesh{ box{ {0, 0, 0}, {1, 1, p.height} }, max_edge = 0.5 }:write "box.stl".triangles end }
print(heights.done, heights.failed)
