-- expect bad_argument two_arguments.lua:2: read_surface: takes one table, not several arguments
read_surface("box.stl", "box.stl")
