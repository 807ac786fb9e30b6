// Starts a Slurm of two tasks on this machine for tools/faults. Writes SLURM_CONF to stdout, then executes the commands read from stdin until its end: "down",
// "back", "kill", "restart" (node and controller). Answers "done" to each command. Exit status 2: Slurm is not available on this machine.
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>

#include "tests/scripting/series/slurm_cluster.h"

int main() {
  using sterna::test::SlurmCluster;
  if (!SlurmCluster::is_possible()) {
    std::cerr << "no slurm-wlm with munge, or not the right to start it\n";
    return 2;
  }
  try {
    SlurmCluster cluster;
    std::cout << cluster.conf().string() << std::endl;
    for (std::string order; std::getline(std::cin, order);) {
      if (order == "down") cluster.take_node_down();
      else if (order == "back") cluster.bring_node_back();
      else if (order == "kill") cluster.kill_controller();
      else if (order == "restart") cluster.restart_controller();
      else throw std::runtime_error("no order " + order);
      std::cout << "done" << std::endl;
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
