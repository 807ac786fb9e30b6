// How much memory is left. For forecasts and reports only, never for results.
#pragma once

namespace sterna {

/// Bytes that this process may still take: the least of what the kernel thinks is free, what is left of its address space (ulimit -v), and of its control group
/// (containers, jobs of Slurm). Infinite where nothing is told.
double available_memory();
/// Bytes that this process holds in memory now; 0 where it is not told.
double resident_memory();

}  // namespace sterna
