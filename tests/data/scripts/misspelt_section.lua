-- expect bad_argument misspelt_section.lua:3: wing: section 2: unknown key "dihedrall", did you mean "dihedral"?
local deg5 = 5*deg
wing{ name = "wing", sections = { { y = 0, chord = 2, airfoil = "naca0012" }, { y = 3, dihedrall = deg5 } } }
