#include "io/output/atomic_file.h"
#include "io/output/atomic_folder.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <fstream>

#include "io/file/volume_file.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"
#include "tests/support/hybrid_shapes.h"

namespace sterna::io {
namespace {

using test::bytes_of;
using test::expect_error;
using test::files_in;

/// Limits files of this process to `n` bytes during its lifetime: simulates a full disk, also for root.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t n) {
    old_handler_ = ::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &old_);
    rlimit limit = old_;
    limit.rlim_cur = n;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    ::signal(SIGXFSZ, old_handler_);
  }

 private:
  rlimit old_{};
  sighandler_t old_handler_;
};

std::filesystem::path old_file(const std::string& name) { return test::write_text(name, "old"); }

TEST(AtomicFile, ReplacesTheOldFileOnlyOnCommit) {
  const auto path = old_file("a.txt");
  AtomicFile file(path);
  file.append("01234");
  file.append("56789");
  file.overwrite(3, "XYZ");
  EXPECT_EQ(file.size(), 10u);
  EXPECT_EQ(bytes_of(path), "old");
  file.commit();
  EXPECT_EQ(bytes_of(path), "012XYZ6789");
  EXPECT_EQ(files_in(path.parent_path()), std::vector<std::string>{"a.txt"});
}

TEST(AtomicFile, LeavesNoTraceWhenNotCommitted) {
  const auto path = old_file("a.txt");
  {
    AtomicFile file(path);
    file.append("new");
  }
  EXPECT_EQ(bytes_of(path), "old");
  EXPECT_EQ(files_in(path.parent_path()), std::vector<std::string>{"a.txt"});
}

TEST(AtomicFile, TwoAtATimeDoNotMeet) {
  const auto folder = test::scratch();
  AtomicFile a(folder / "a"), b(folder / "b");
  a.append("a");
  b.append("b");
  a.commit();
  b.commit();
  EXPECT_EQ(bytes_of(folder / "a") + bytes_of(folder / "b"), "ab");
}

TEST(AtomicFile, FollowsLinksAndKeepsPermissions) {
  const auto path = old_file("target");
  ::chmod(path.c_str(), 0640);
  const auto link = path.parent_path() / "link";
  std::filesystem::create_symlink("target", link);
  AtomicFile file(link);
  file.append("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(bytes_of(path), "new");
  EXPECT_EQ(std::filesystem::status(path).permissions(), std::filesystem::perms{0640});
}

TEST(AtomicFile, RefusesWhatIsNotAFile) {
  const auto folder = test::scratch();
  expect_error(ErrorCode::write_failed, "not a regular file", [&] { AtomicFile file(folder); });
  std::filesystem::create_symlink("/dev/null", folder / "mesh.su2");
  expect_error(ErrorCode::write_failed, "not a regular file", [&] { AtomicFile file(folder / "mesh.su2"); });
  expect_error(ErrorCode::write_failed, "No such file or directory", [&] { AtomicFile file(folder / "absent" / "mesh.su2"); });
}

TEST(AtomicFile, FullDiskLeavesTheOldFile) {
  const HybridMesh mesh = test::sphere_shell(4);
  for (const std::string name : {"mesh.su2", "mesh.vtu", "mesh.cgns", "mesh.adf.cgns", "mesh.taumesh", "mesh.vtkhdf"}) {
    const auto path = old_file(name);
    expect_error(ErrorCode::write_failed, "File too large", [&] {
      const FileSizeLimit limit(10000);
      write_volume_file(mesh, path, RunContext({.threads = 2}));
    });
    EXPECT_EQ(bytes_of(path), "old");
    EXPECT_EQ(files_in(path.parent_path()), std::vector<std::string>{name});
  }
}

TEST(AtomicFile, CancelLeavesTheOldFile) {
  for (const std::string name : {"mesh.su2", "mesh.vtu", "mesh.cgns", "mesh.adf.cgns", "mesh.taumesh", "mesh.vtkhdf"}) {
    const auto path = old_file(name);
    std::stop_source stop;
    // The writer's own progress report triggers the stop, after the temporary file has been started.
    const RunContext context({.threads = 2, .stop = stop.get_token(), .progress = [&](const ProgressState&) { stop.request_stop(); }});
    expect_error(ErrorCode::cancelled, "", [&] { write_volume_file(test::sphere_shell(20), path, context); });
    EXPECT_EQ(bytes_of(path), "old");
    EXPECT_EQ(files_in(path.parent_path()), std::vector<std::string>{name});
  }
}

/// Moves the modification time of a file into the past.
void make_old(const std::filesystem::path& path) {
  std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now() - std::chrono::minutes(5));
}

TEST(AtomicFile, RemovesWhatKilledRunsLeft) {
  const auto folder = test::scratch();
  for (const char* const name : {".sterna-1-0.part", ".sterna-99999-3.part", "mine.part", ".sterna-notes"}) {
    std::ofstream(folder / name) << "old";
    make_old(folder / name);
  }
  std::ofstream(folder / ".sterna-2-0.part") << "just begun by another process";
  std::filesystem::create_directories(folder / ".sterna-3-0.part" / "deep");
  make_old(folder / ".sterna-3-0.part");
  {
    AtomicFile file(folder / "a");
    file.append("a");
    file.commit();
  }
  EXPECT_EQ(test::files_in(folder), (std::vector<std::string>{".sterna-2-0.part", ".sterna-notes", "a", "mine.part"}));
}

TEST(AtomicFile, LeavesWhatOthersStillWrite) {
  const auto folder = test::scratch();
  AtomicFile slow(folder / "slow");
  slow.append("half");
  make_old(slow.temporary());
  AtomicFolder slow_folder(folder / "polyMesh", "faces");
  std::ofstream(slow_folder.file("faces")) << "half";
  make_old(slow_folder.file("faces").parent_path());
  {
    AtomicFile quick(folder / "quick");
    quick.commit();
    AtomicFolder quick_folder(folder / "other", "faces");
    quick_folder.commit();
  }
  slow.commit();
  slow_folder.commit();
  EXPECT_EQ(test::bytes_of(folder / "slow"), "half");
  EXPECT_EQ(test::bytes_of(folder / "polyMesh" / "faces"), "half");
  EXPECT_EQ(test::files_in(folder), (std::vector<std::string>{"other", "polyMesh", "quick", "slow"}));
}

}  // namespace
}  // namespace sterna::io
