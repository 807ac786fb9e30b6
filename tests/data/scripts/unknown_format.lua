-- expect unsupported_format unknown_format.lua:2: writing out.wgs
read_surface "box.stl":write "out.wgs"
