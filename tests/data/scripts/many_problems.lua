-- expect bad_argument many_problems.lua:5: volume_mesh: 6 problems in this table
-- expect unknown key "envelope.max_grwoth", did you mean "max_growth"?
-- expect layers: -1 is not allowed, expected a whole number in 0 .. 1000
-- expect first_height: "thin" is not allowed, expected a number
volume_mesh{ read_surface "box.stl",
  layers = -1,
  first_height = "thin",
  feature_angle = 35,
  envelope = { max_grwoth = 1.2 },
  farfield = 20,
  prisms = { wall_perpendicularity = 2 } }
-- expect feature_angle: 35 rad (2005.35 deg) is not allowed, expected a number in 0.572958 deg .. 177.617 deg (angles are in radians; write degrees as 40*deg)
-- expect farfield: expected a table with options of this stage, not a number
-- expect prisms.wall_perpendicularity: 2 is not allowed, expected a number in 0 .. 1
