-- expect unsupported_format smx_of_cad.lua:2: writing out.smx: .smx requires components defined as data, and this model has none (it is a box)
box{ {0, 0, 0}, {1, 1, 1} }:write "out.smx"
