-- Report pages of a real mesh with all data of a run: coverage, stages, options. The argument `data` is the folder of the data.
local data = args{ data = "../../../build/release/test_data" }.data

local half_f6 = half(read_surface{ data .. "/surfaces/clean/dlr_f6_184k.stl", unit = mm, split_angle = 40*deg })
local mesh = volume_mesh{ half_f6, layers = 8, first_height = 1e-5 * half_f6.length, farfield = sphere{ radius = 50 * half_f6.length } }
report{ mesh, "half_f6.html", title = "Half of the DLR-F6", cuts = { "leading edge", { y = 0.3 * half_f6.length } } }
draw{ mesh, "half_f6.png", view = "iso", color = "layer_height" }
draw{ mesh, "half_f6_cut.png", cut = "leading edge" }
