-- expect bad_argument require "../box": modules lie beside the script
require "../box"
