#include "scripting/cli/cli.h"

int main(int argc, char** argv) { return sterna::scripting::run_command_line(argc, argv); }
