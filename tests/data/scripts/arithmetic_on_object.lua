-- expect script_failed arithmetic_on_object.lua:2: attempt to perform arithmetic on a sterna.model value
print(2 * box{ {0, 0, 0}, {1, 1, 1} })
