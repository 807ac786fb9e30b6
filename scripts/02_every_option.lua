-- Every option of every stage at its default, to copy from. help(read_surface) and help(volume_mesh) say what each one does, its unit and its range.
--   ./run scripts/02_every_option.lua

local wall = read_surface{ "data/cessna.msh.gz",
  unit = ft,                        -- metres per unit of the file: mm, cm, inch, ft or a number; default 1
  split_angle = 60*deg,             -- default: patches as the file names them
  weld_tolerance = "automatic",     -- metres
  allow_open = false,
  check_intersections = true,
}

-- Of one surface alone union only proves that it is a solid; here stand the parts that stick in each other: union{ wall, "sting.stl", unit = mm }.
wall = union{ wall,
  remesh = true,                    -- better triangles along the curves in which parts cross
  strip_width = 4,                  -- so far from the curves, in local edge lengths
  strip_growth = 1.3,               -- of edge lengths away from the curves
  deviation = 0.01,                 -- from the input, in local edge lengths
  keep_cavities = false,            -- hollows that the parts enclose
}

local mesh = volume_mesh{ wall,
  -- What the layers are asked to be; options can stand here or in the table of their stage, below.
  layers = 30,
  first_height = 1e-6 * wall.length,

  envelope = {
    max_growth = 1.4,
    max_thickness = "automatic",
    feature_angle = 35*deg,
    height_gradient = 0.5,
    height_sweeps = 20,
    direction_sweeps = 50,
    envelope_sweeps = 5,
    untangle_share = 0.7,
    max_retract_sweeps = 40,
    height_floor = 0.938,         -- share of the target height to which smoothing may lower
    optimiser = "descent",        -- none, descent, lbfgs (ours), mma, ccsaq (NLopt)
    optimiser_evaluations = 30,
    height_weight = 1.0,          -- of full height, against lines normal to the wall
    top_weight = 0.4,             -- of lines normal to the envelope
    barrier_weight = 0.02,        -- around invalid elements
  },
  prisms = {
    wall_perpendicularity = 0.1,
  },
  farfield = sphere{
    radius = 50 * wall.length,
    edge = 10 * wall.length,
  },
  size = {
    size_growth = 1.3,                 -- of neighbouring tetrahedra
    size_max = "automatic",           -- longest edge; automatic: no limit
  },
  sources = {},                        -- smaller tetrahedra: box{ {-1, -2, -1}, {9, 2, 3}, size = 0.05 }, point, line, sphere, cylinder, wake, size_samples
  tetrahedra = {
    engine = "automatic",           -- or "tetgen", "hxt"
    radius_edge = 1.2,              -- TetGen
    two_pass = false,               -- TetGen: a coarse mesh gives the sizes of the mesh itself
    hxt_improve_below = 0,          -- HXT's own improvement; 0: none
    max_new_points = "automatic",   -- more are a failure; automatic: no limit
    boundary_splits = "ladder",     -- never, ladder, always: may TetGen split triangles of envelope and farfield; ladder: after other failures
    try_other_engine = true,        -- after a failure that would repeat itself
    repair_boundary = true,         -- when nothing of that helps: a lower, smoother layer around slivers, folds and gaps of its top, and all again
    fall_back_on_limits = false,    -- also after a time or memory limit; the manifest then says "not reproducible"
    memory_limit = 20e9,            -- bytes, of the helper process
    time_limit = "automatic",       -- seconds; automatic: none
    helper_folder = "",             -- where sterna-tet-tetgen and sterna-tet-hxt are; empty: beside sterna
  },
  improve = {                         -- of tetrahedra with dihedral angles beyond these
    improve_min_angle = 12*deg,
    improve_max_angle = 160*deg,
    improve_rounds = 30,            -- 0: none
  },
}

mesh:check{ intersections = true, quality = true, findings_per_kind = 10 }
mesh:write "every_option.vtu"
print(string.format("%d prisms, %d tetrahedra, %.1f %% of the area has its full height", mesh.prisms, mesh.tetrahedra, 100 * mesh.coverage))
