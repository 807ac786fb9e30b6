-- expect unknown_option misspelt_method.lua:2: model: there is no "rotat", did you mean "rotate"?
box{ {0, 0, 0}, {1, 1, 1} }:rotat{ pitch = 4*deg }
