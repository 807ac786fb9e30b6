-- expect bad_argument module_outside.lua:2: require "../box": modules lie beside the script
require "../box"
