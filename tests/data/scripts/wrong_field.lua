-- expect unknown_option wrong_field.lua:3: surface: there is no "lenght", did you mean "length"?
local wall = read_surface "box.stl"
print(wall.lenght)
