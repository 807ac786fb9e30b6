// Child processes: arguments, descriptors, output, working directory, exit status, and killing the whole process group.
#include "geom/base/child_process.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace {

using namespace sterna;
namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

fs::path new_folder(const std::string& name) {
  const fs::path folder = fs::path(testing::TempDir()) / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

TEST(ChildProcess, OutputAndErrorsOverwriteFileInGivenFolder) {
  const fs::path folder = new_folder("child_process_output"), output = folder / "words.txt";
  std::ofstream(output) << "of an earlier run, longer than what comes now";
  ChildProcess child({.words = {"sh", "-c", "pwd; echo \"$1\" >&2; exit 3", "sh", "two words"}, .descriptors = {}, .output = output, .folder = folder});
  const int status = child.wait();
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 3);
  EXPECT_EQ(text_of(output), fs::canonical(folder).string() + "\ntwo words\n");
}

TEST(ChildProcess, PipeDescriptorsAreAboveInheritedDescriptors) {
  Pipe first(ErrorCode::internal, "test"), second(ErrorCode::internal, "test");
  for (const Pipe* pipe : {&first, &second}) {
    EXPECT_GE(pipe->read_end.value, k_first_free_descriptor);
    EXPECT_GE(pipe->write_end.value, k_first_free_descriptor);
  }
  ChildProcess child({.words = {"sh", "-c", "echo third >&3; echo fourth >&4"},
                      .descriptors = {{second.write_end.value, 3}, {first.write_end.value, 4}},
                      .output = {},
                      .folder = {}});
  first.write_end.reset();
  second.write_end.reset();
  std::string of_first, of_second;
  while (read_some(first.read_end.value, of_first)) {
  }
  while (read_some(second.read_end.value, of_second)) {
  }
  EXPECT_EQ(child.wait(), 0);
  EXPECT_EQ(of_first, "fourth\n");
  EXPECT_EQ(of_second, "third\n");
}

TEST(ChildProcess, MissingProgramIsErrorWithName) {
  try {
    ChildProcess child({.words = {"sterna-no-such-program"}, .descriptors = {}, .output = {}, .folder = {}});
    FAIL() << "it was started";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::file_not_found);
    EXPECT_NE(std::string(error.what()).find("sterna-no-such-program"), std::string::npos) << error.what();
  }
}

TEST(ChildProcess, GrandchildrenEndWithTheObject) {
  Pipe pipe(ErrorCode::internal, "test");
  {
    ChildProcess child({.words = {"sh", "-c", "sleep 60 & echo begun; wait"}, .descriptors = {{pipe.write_end.value, 1}}, .output = {}, .folder = {}});
    pipe.write_end.reset();
    std::string text;
    while (text.find('\n') == std::string::npos && read_some(pipe.read_end.value, text)) {
    }
    EXPECT_EQ(text, "begun\n");
    EXPECT_FALSE(child.ended());
  }
  // The pipe closes only when the last process of the group has ended; the test's time limit is shorter than the sleep.
  const auto begin = std::chrono::steady_clock::now();
  std::string rest;
  while (read_some(pipe.read_end.value, rest)) {
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
}

}  // namespace
