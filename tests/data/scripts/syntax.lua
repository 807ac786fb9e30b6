-- expect script_failed syntax.lua:4: unexpected symbol near '}'
local wall = read_surface "box.stl"
volume_mesh{ wall,
  layers = }
