-- expect bad_argument wrong_kind.lua:2: 
box{ {0, 0, 0}, {1, 1, 1} }:kinds{ ["*"] = "inlet" }
-- expect inlet
