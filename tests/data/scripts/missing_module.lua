-- expect file_not_found missing_module.lua:3: reading 
-- expect shapes.lua: the script cannot be opened
require "shapes"
