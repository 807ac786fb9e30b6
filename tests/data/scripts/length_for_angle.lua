-- expect bad_argument length_for_angle.lua:2: read_surface: split_angle: 40 rad (2291.83 deg) is not allowed
read_surface{ "box.stl", split_angle = 40 }
-- expect write degrees as 40*deg
