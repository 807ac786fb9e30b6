-- expect file_not_found shapes.lua: the script cannot be opened
require "shapes"
