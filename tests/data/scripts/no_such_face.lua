-- expect bad_argument no_such_face.lua:2: model:kinds: no face has a name like "inlet*"
box{ {0, 0, 0}, {1, 1, 1} }:kinds{ ["inlet*"] = "inflow" }
