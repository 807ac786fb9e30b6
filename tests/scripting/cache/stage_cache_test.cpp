// The cache as a store: an entry is returned to the bit or not at all.
#include "scripting/cache/stage_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <iterator>

#include "scripting/values/value_keys.h"
#include "tests/support/data.h"
#include "tests/support/error_of.h"

namespace sterna::scripting {
namespace {

using testing::HasSubstr;

class StageCacheTest : public testing::Test {
 protected:
  StageCache cache(double limit = k_cache_limit, const std::string& identity = "this build") const {
    return StageCache({.folder = folder_, .limit = limit, .identity = identity});
  }
  static ContentKey key(int number) { return KeyMaker("test").add(number).key(); }
  void store(const StageCache& cache, int number, const std::string& text) {
    cache.store(
        "stage", key(number), [&](ByteSink& sink) { write_value(sink, text); }, context_);
  }
  /// Returns the entry, or "-" if there is none.
  std::string find(const StageCache& cache, int number) {
    std::string text = "-";
    const bool is_found = cache.find(
        "stage", key(number), [&](ByteSource& source) { read_value(source, text); }, context_);
    return is_found ? text : "-";
  }
  std::filesystem::path only_file() const {
    const std::vector<CacheEntry> entries = StageCache::entries(folder_);
    EXPECT_EQ(entries.size(), 1u);
    return entries.empty() ? std::filesystem::path() : entries.front().file;
  }
  static std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static void write_bytes(const std::filesystem::path& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

  const std::filesystem::path folder_ = test::scratch() / "cache";
  std::string log_;
  const RunContext context_{{.threads = 1, .log = [this](LogLevel level, std::string_view line) {
                               if (level == LogLevel::warning) log_ += std::string(line) + "\n";
                             }}};
};

TEST_F(StageCacheTest, WhatWasStoredComesBackAndNothingElse) {
  const StageCache one = cache();
  EXPECT_EQ(find(one, 1), "-");
  store(one, 1, "a text");
  store(one, 2, std::string(3'000'000, 'x') + "end");  // longer than one block
  EXPECT_EQ(find(one, 1), "a text");
  EXPECT_EQ(find(one, 2), std::string(3'000'000, 'x') + "end");
  EXPECT_EQ(find(one, 3), "-");
  EXPECT_FALSE(one.find(
      "another stage", key(1), [](ByteSource&) { ADD_FAILURE(); }, context_));
  EXPECT_EQ(find(cache(), 1), "a text") << "another process";
  EXPECT_EQ(find(cache(k_cache_limit, "another build"), 1), "-");
  EXPECT_EQ(log_, "");
}

TEST_F(StageCacheTest, EqualValuesGiveOneEntryOfEqualBytes) {
  store(cache(), 1, "text");
  const std::string before = bytes_of(only_file());
  store(cache(), 1, "text");
  EXPECT_EQ(bytes_of(only_file()), before);
}

TEST_F(StageCacheTest, DamagedEntriesAreNoticedRemovedAndMadeAnew) {
  const std::string text = "some text that is long enough to be damaged";
  const StageCache one = cache();
  store(one, 1, text);
  const std::filesystem::path path = only_file();
  const std::string whole = bytes_of(path);
  std::vector<std::string> damaged = {
      "", whole.substr(0, 10), whole.substr(0, 48), whole.substr(0, whole.size() - 1), whole + "x", std::string(whole.size(), '\0')};
  for (std::size_t i = 0; i < whole.size(); ++i) {
    damaged.push_back(whole);
    damaged.back()[i] = static_cast<char>(damaged.back()[i] ^ 4);
  }
  for (std::size_t i = 0; i < damaged.size(); ++i) {
    write_bytes(path, damaged[i]);
    log_.clear();
    EXPECT_EQ(find(one, 1), "-") << i;
    EXPECT_THAT(log_, HasSubstr("is damaged")) << i;
    EXPECT_FALSE(std::filesystem::exists(path)) << i;
    store(one, 1, text);
    EXPECT_EQ(find(one, 1), text) << i;
  }
}

TEST_F(StageCacheTest, EntryUnderOtherNameIsRefused) {
  const StageCache one = cache();
  store(one, 1, "one");
  const std::string bytes = bytes_of(only_file());
  std::filesystem::remove(only_file());
  store(one, 2, "two");
  write_bytes(only_file(), bytes);
  EXPECT_EQ(find(one, 2), "-");
  EXPECT_THAT(log_, HasSubstr("another key"));
}

TEST_F(StageCacheTest, ReadersThatFindSomethingElseRemoveTheEntry) {
  const StageCache one = cache();
  store(one, 1, "one");
  EXPECT_FALSE(one.find(
      "stage", key(1),
      [](ByteSource& source) {
        std::vector<double> numbers;
        read_value(source, numbers);
      },
      context_));
  EXPECT_THAT(log_, HasSubstr("damaged"));
  EXPECT_TRUE(StageCache::entries(folder_).empty());
}

TEST_F(StageCacheTest, LeastRecentlyUsedEntriesAreRemovedAboveLimit) {
  const StageCache one = cache(3500.0);
  const auto age = [&](double seconds) {  // instead of waiting for the clock
    for (const CacheEntry& entry : StageCache::entries(folder_))
      std::filesystem::last_write_time(entry.file, std::filesystem::last_write_time(entry.file) - std::chrono::milliseconds(static_cast<int>(1000 * seconds)));
  };
  for (int i = 1; i <= 3; ++i) {
    store(one, i, std::string(1000, 'x'));
    age(10.0);
  }
  EXPECT_NE(find(one, 1), "-");  // used just now
  store(one, 4, std::string(1000, 'x'));
  EXPECT_NE(find(one, 1), "-");
  EXPECT_EQ(find(one, 2), "-");
  EXPECT_NE(find(one, 3), "-");
  EXPECT_NE(find(one, 4), "-");
  store(one, 5, std::string(10000, 'x'));  // larger than the whole limit: the entry just made stays
  EXPECT_NE(find(one, 5), "-");
  EXPECT_EQ(StageCache::entries(folder_).size(), 1u);
}

TEST_F(StageCacheTest, WhatIsBeingReadDoesNotGo) {
  const StageCache one = cache(1500.0);
  store(one, 1, std::string(1000, 'x'));
  bool is_read = false;
  ASSERT_TRUE(one.find(
      "stage", key(1),
      [&](ByteSource& source) {
        store(cache(1500.0), 2, std::string(1000, 'y'));
        EXPECT_EQ(StageCache::entries(folder_).size(), 2u);
        std::string text;
        read_value(source, text);
        is_read = text == std::string(1000, 'x');
      },
      context_));
  EXPECT_TRUE(is_read);
}

TEST_F(StageCacheTest, UnwritableFolderIsAWarning) {
  const StageCache one = cache();
  std::filesystem::remove_all(folder_);
  std::ofstream(folder_) << "a file";
  store(one, 1, "one");
  EXPECT_THAT(log_, HasSubstr("is not stored"));
  EXPECT_EQ(find(one, 1), "-");
}

TEST_F(StageCacheTest, ListedAndCleared) {
  store(cache(), 1, "one");
  store(cache(), 2, "two");
  for (const CacheEntry& entry : StageCache::entries(folder_)) {
    EXPECT_EQ(entry.stage, "stage");
    EXPECT_EQ(entry.bytes, std::filesystem::file_size(entry.file));
  }
  std::ofstream(folder_ / "mine.txt") << "not the cache's";
  EXPECT_EQ(StageCache::clear(folder_), 2u);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "mine.txt"));
  test::expect_error(ErrorCode::file_not_found, "none: there is no such folder", [&] { (void)StageCache::entries(folder_ / "none"); });
}

}  // namespace
}  // namespace sterna::scripting
