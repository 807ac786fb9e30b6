// Starts a real Slurm on this machine for the duration of a test: controller and one node on 127.0.0.1, without systemd, as root.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "tests/support/process.h"

namespace sterna::test {

/// Sets SLURM_CONF for this process and all processes that it starts. All daemons end with the object.
class SlurmCluster {
 public:
  /// Returns true if all programs are installed and the user is root.
  static bool is_possible();
  /// \throws std::runtime_error with the output of the daemons if the cluster does not start
  SlurmCluster();
  ~SlurmCluster();
  SlurmCluster(const SlurmCluster&) = delete;
  SlurmCluster& operator=(const SlurmCluster&) = delete;

  /// Returns the output of squeue for all jobs; empty if there is none.
  std::string queue() const;
  /// Returns state, system call and threads of each job that still runs a case; empty if no job runs, independent of the queue.
  std::string running_cases() const;
  /// Returns state and logs of the daemons, for a message.
  std::string account() const;
  std::filesystem::path conf() const { return folder_ / "slurm.conf"; }
  /// Takes the node down: its jobs are lost, and nothing starts until the node is back. \throws std::runtime_error if scontrol refuses for a minute
  void take_node_down() const;
  void bring_node_back() const;
  /// Kills the controller and restarts it from its saved state.
  void kill_controller();
  void restart_controller();

 private:
  void start_munge();
  void write_conf();
  void start_controller();
  std::string set_node(const std::string& state) const;  ///< error output of scontrol
  void wait_until_idle();
  void stop() noexcept;

  std::filesystem::path folder_;  ///< in /tmp: the folder holds sockets, whose names may have 107 characters
  std::unique_ptr<StartedProcess> munge_, controller_, node_;
};

}  // namespace sterna::test
