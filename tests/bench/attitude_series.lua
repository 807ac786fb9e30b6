-- A series in which only the attitude of the model changes. tools/measure_series runs it with and without its cache.
local a = args{ model = "", unite = false, n = 4, from = -2, step = 2, layers = 30, first_height = 1e-5, cache = true, curvature_angle = 12, tunnel = 0 }
local model = a.model:match "%.smx$" and read_smx(a.model) or a.model:match "%.xml$" and read_cpacs(a.model) or read_cad(a.model)
if a.unite then model = union{ model } end
local section = a.tunnel > 0 and test_section{ length = 6*a.tunnel, width = 2.4*a.tunnel, height = 1.8*a.tunnel, position = { -2.5*a.tunnel, 0, 0 }, walls = "slip" }
series{ "attitude", over = { alpha = range(a.from, a.from + (a.n - 1)*a.step, a.step) }, run = jobs{ 1 }, cache = a.cache,
  case = function(p)
    local turned = model:rotate{ pitch = p.alpha*deg }
    local wall = section and surface_mesh{ turned, section, curvature_angle = a.curvature_angle*deg } or surface_mesh{ turned, curvature_angle = a.curvature_angle*deg }
    local farfield = not section and sphere{ radius = 30*wall.length } or nil
    return volume_mesh{ wall, layers = a.layers, first_height = a.first_height, farfield = farfield }:write "mesh.su2"
  end }
