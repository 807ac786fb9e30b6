-- expect bad_argument dot_instead_of_colon.lua:3: surface:write: is a method
local wall = read_surface "box.stl"
wall.write("out.vtu")
