-- expect bad_argument two_about.lua:2: model:rotate: 2 problems in this table
box{ {0, 0, 0}, {1, 1, 1} }:rotate{ abuot = {1, 0, 0}, axis = {0, 0, 1} }
-- expect unknown key "abuot", did you mean "about"?
-- expect axis and angle belong together
