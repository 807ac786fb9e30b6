-- expect unsupported_format unknown_format.lua:2: writing out.stl
read_surface "box.stl":write "out.stl"
