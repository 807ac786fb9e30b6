-- expect file_not_found missing_module.lua:2: shapes.lua: the script cannot be opened
require "shapes"
