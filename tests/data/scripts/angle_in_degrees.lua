-- expect bad_argument angle_in_degrees.lua:3: wing:deflect: angle: 10 rad (572.958 deg) is not allowed
-- expect write degrees as 40*deg
wing{ sections = { { y = 0, chord = 2, airfoil = "naca0012" }, { y = 3 } } }:deflect{ "flap", from = {0.1, 0.7}, to = {0.5, 0.7}, angle = 10 }
