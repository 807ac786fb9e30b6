-- expect bad_argument winglet_that_folds.lua:3: wing: winglet: bend: a turn by 78 deg over 0.1 of 0.5 m, at (0, 3, 0)
-- Its tip is thicker than the radius of the bend.
wing{ name = "wing", symmetric = true, position = { 0, 0, 0 }, sections = { { y = 0, chord = 1, airfoil = "naca0018" }, { y = 3 } }, winglet = { height = 0.5, cant = 78*deg, bend = 0.1 } }
