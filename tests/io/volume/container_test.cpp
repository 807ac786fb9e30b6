// Shared parts of the CGNS, TAU and VTKHDF readers: the image that the helper program makes of a file, and failures of the helper.
#include <gmock/gmock.h>
#include <hdf5.h>

#include <cstring>
#include <fstream>
#include <stop_token>
#include <thread>

#include "io/container/container_file.h"
#include "io/container/hdf5_output.h"
#include "io/volume/volume_cgns.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"
#include "tests/support/hybrid_shapes.h"

namespace sterna::io {
namespace {

using testing::HasSubstr;

const RunContext k_quiet({.threads = 1});

// ---- the image

/// Returns a root with an attribute, a dataset of 2 x 3 numbers, and a group with a dataset that has an error.
std::string image_bytes() {
  const std::vector<std::int32_t> numbers = {1, 2, 3, 4, 5, 6};
  std::string text;
  const auto location = [&](std::string_view word) {
    const wire::Text location{.begin = text.size(), .size = word.size()};
    text += word;
    return location;
  };
  std::vector<wire::NodeRecord> nodes(5);
  nodes[1] = {.parent = 0, .role = wire::Role::attribute, .kind = NumberKind::text, .rank = 1, .name = location("label"), .extents = {4}};
  nodes[2] = {.parent = 0, .role = wire::Role::dataset, .kind = NumberKind::i4, .rank = 2, .name = location("numbers"), .extents = {2, 3}};
  nodes[3] = {.parent = 0, .role = wire::Role::group, .name = location("group")};
  nodes[4] = {.parent = 3,
              .role = wire::Role::dataset,
              .trouble = wire::Trouble::unsupported,
              .name = location("packed"),
              .problem = location("it is packed by magic")};
  const std::uint64_t values = sizeof(wire::ImageHeader) + sizeof(wire::NodeRecord) * nodes.size() + text.size();
  nodes[1].begin = values;
  nodes[1].n_bytes = 4;
  nodes[2].begin = values + 4;
  nodes[2].n_bytes = 24;
  const wire::ImageHeader header{.n_nodes = 5, .text_size = text.size()};
  std::string bytes(sizeof header, '\0');
  std::memcpy(bytes.data(), &header, sizeof header);
  bytes.append(reinterpret_cast<const char*>(nodes.data()), sizeof(wire::NodeRecord) * nodes.size());
  bytes += text + "mesh";
  bytes.append(reinterpret_cast<const char*>(numbers.data()), 24);
  return bytes;
}

ContainerImage image_of(const std::string& bytes) { return {nullptr, std::as_bytes(std::span(bytes)), "a.cgns"}; }

/// Returns a sum over all values, so that every value is accessed.
std::int64_t sum_of(const ContainerNode& node) {
  std::int64_t sum = 0;
  const auto add = [&](const ContainerValues& values) {
    if (values.trouble != wire::Trouble::none) return;
    for (std::uint64_t i = 0; i < values.array.count() && is_integer(values.array.kind); ++i) sum += values.array.integer(i) & 0xff;
    sum += static_cast<std::int64_t>(values.array.text().size());
  };
  for (const auto& [name, values] : node.attributes) add(values);
  if (node.role == wire::Role::dataset) add(node.values);
  for (const ContainerNode& child : node.children) sum += sum_of(child);
  return sum;
}

TEST(ContainerImage, IsATree) {
  const std::string bytes = image_bytes();
  const ContainerImage image = image_of(bytes);
  EXPECT_EQ(image.root().attribute("label")->text(), "mesh");
  const NumberArray numbers = image.data(image.child(image.root(), "numbers"));
  EXPECT_EQ(numbers.extents, (std::vector<std::uint64_t>{2, 3}));
  EXPECT_EQ(numbers.integer(5), 6);
  EXPECT_EQ(numbers.where, "/numbers");
  test::expect_error(ErrorCode::unsupported_format, "/group/packed: it is packed by magic",
                     [&] { image.data(image.child(image.child(image.root(), "group"), "packed")); });
  test::expect_error(ErrorCode::file_malformed, "/group/none: there is no such group", [&] { image.child(image.child(image.root(), "group"), "none"); });
  test::expect_error(ErrorCode::file_malformed, "/group: this is not a dataset", [&] { image.data(image.child(image.root(), "group")); });
}

TEST(ContainerImage, ChangedOrMissingBytesGiveImageOrError) {
  const std::string whole = image_bytes();
  int n_refused = 0;
  const auto attempt = [&](const std::string& bytes) {
    const std::string copy(bytes);  // a separate block, so that a sanitizer detects reads beyond its end
    try {
      sum_of(image_of(copy).root());
    } catch (const Error& error) {
      ++n_refused;
      EXPECT_TRUE(error.code() == ErrorCode::file_malformed || error.code() == ErrorCode::unsupported_format) << error.what();
    }
  };
  for (std::size_t n = 0; n < whole.size(); ++n) attempt(whole.substr(0, n));
  EXPECT_EQ(n_refused, static_cast<int>(whole.size()));
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (const int mask : {0x01, 0x02, 0x04, 0x08, 0x10, 0x40, 0x80, 0xff}) {
      std::string bytes = whole;
      bytes[i] = static_cast<char>(bytes[i] ^ mask);
      attempt(bytes);
    }
  }
}

// ---- the helper

/// Creates a folder where the helper is a shell script.
std::string folder_with_helper(const std::filesystem::path& folder, const std::string& script) {
  std::ofstream(folder / "sterna-read-container") << "#!/bin/sh\n" << script << "\n";
  std::filesystem::permissions(folder / "sterna-read-container", std::filesystem::perms::owner_all);
  return folder.string();
}

std::filesystem::path hdf5_file() { return test::write_text("a.vtkhdf", "\x89HDF\r\n\x1a\n"); }

TEST(ContainerHelper, ItsDeathIsAnErrorOfTheFile) {
  const auto path = hdf5_file();
  const auto read_with = [&](const std::string& script) {
    read_container(path, ContainerFormat::hdf5, {}, k_quiet, folder_with_helper(path.parent_path(), script));
  };
  test::expect_error(ErrorCode::file_malformed, "a.vtkhdf: the file: the HDF5 library crashed while reading the file: signal 11",
                     [&] { read_with("kill -SEGV $$"); });
  test::expect_error(ErrorCode::file_malformed, "the HDF5 library did not finish", [&] { read_with("kill -XCPU $$"); });
  test::expect_error(ErrorCode::file_malformed, "exit status 3; end of its output: \"oh\"", [&] { read_with("echo oh; exit 3"); });
  test::expect_error(ErrorCode::file_malformed, "the image has 0 bytes", [&] { read_with("exit 0"); });
  test::expect_error(ErrorCode::file_malformed, "another version", [&] { read_with("head -c 500 /dev/zero >&4"); });
  test::expect_error(ErrorCode::unsupported_format, "build the target sterna-read-container",
                     [&] { read_container(path, ContainerFormat::hdf5, {}, k_quiet, "/no_such_folder"); });
}

TEST(ContainerHelper, AStopEndsIt) {
  std::stop_source stop;
  const RunContext context({.threads = 1, .stop = stop.get_token()});
  const auto path = hdf5_file();
  const std::string folder = folder_with_helper(path.parent_path(), "exec sleep 100");
  const std::jthread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    stop.request_stop();
  });
  test::expect_error(ErrorCode::cancelled, "", [&] { read_container(path, ContainerFormat::hdf5, {}, context, folder); });
}

// ---- files with references that the libraries would follow anywhere

/// Returns the image of an HDF5 file that `make` fills; the file's objects are closed with the file.
template <class Make>
ContainerImage container_with(const Make& make) {
  const auto path = test::scratch() / "made.h5";
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  make(file);
  H5Fclose(file);
  return read_container(path, ContainerFormat::hdf5, {}, k_quiet);
}

void make_dataset(hid_t file, const char* name, std::vector<hsize_t> extents, hid_t plist) {
  const hid_t space = H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr);
  H5Dclose(H5Dcreate2(file, name, H5T_STD_I32LE, space, H5P_DEFAULT, plist, H5P_DEFAULT));
  H5Sclose(space);
}

TEST(ContainerHdf5, LinksAreNotFollowed) {
  const ContainerImage image = container_with([](hid_t file) {
    H5Gclose(H5Gcreate2(file, "group", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    H5Lcreate_hard(file, "/", file, "/group/cycle", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_soft("/nowhere", file, "/soft", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_external("/etc/passwd", "/", file, "/outside", H5P_DEFAULT, H5P_DEFAULT);
  });
  for (const char* name : {"soft", "outside"}) test::expect_error(ErrorCode::unsupported_format, "is a link by name", [&] { image.child(image.root(), name); });
  test::expect_error(ErrorCode::unsupported_format, "/group/cycle is a link", [&] { image.child(image.child(image.root(), "group"), "cycle"); });
}

TEST(ContainerHdf5, DeclaredSizesAreLimitedByFileSize) {
  const ContainerImage image = container_with([](hid_t file) {
    make_dataset(file, "huge", {1u << 30, 1u << 20}, H5P_DEFAULT);
    make_dataset(file, "never_written", {100}, H5P_DEFAULT);
    make_dataset(file, "nothing", {0, 5}, H5P_DEFAULT);
    const hid_t plist = H5Pcreate(H5P_DATASET_CREATE);
    const hsize_t chunk = 1 << 20, small_chunk = 30;
    H5Pset_chunk(plist, 1, &chunk);
    H5Pset_deflate(plist, 9);
    H5Pset_alloc_time(plist, H5D_ALLOC_TIME_EARLY);  // writes chunks of zeros
    make_dataset(file, "bomb", {20 << 20}, plist);
    H5Pset_alloc_time(plist, H5D_ALLOC_TIME_INCR);
    H5Pset_chunk(plist, 1, &small_chunk);
    make_dataset(file, "missing_chunks", {100}, plist);
    H5Pclose(plist);
    const hid_t outside = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_external(outside, "/etc/passwd", 0, 400);
    make_dataset(file, "in_another_file", {100}, outside);
    H5Pclose(outside);
  });
  const auto refused = [&](const char* name, ErrorCode code, const char* text) {
    test::expect_error(code, text, [&] { image.data(image.child(image.root(), name)); });
  };
  refused("huge", ErrorCode::file_malformed, "that the file can hold");
  refused("never_written", ErrorCode::file_malformed, "were never written");
  refused("bomb", ErrorCode::file_malformed, "that the file can hold");
  refused("missing_chunks", ErrorCode::file_malformed, "found 0 chunks, its extents have 4");
  refused("in_another_file", ErrorCode::unsupported_format, "in other files");
  EXPECT_EQ(image.data(image.child(image.root(), "nothing")).count(), 0u);
}

TEST(ContainerHdf5, WhatIsLeftOutIsNotThere) {
  const auto path = test::scratch() / "mesh.cgns";
  write_volume_cgns(test::hexahedron_with_roof(), path, k_quiet);
  const ContainerImage image = read_container(path, ContainerFormat::cgns, {"ZoneBC_t", "GridCoordinates"}, k_quiet);
  const ContainerNode& zone = image.child(image.child(image.root(), "Base"), "Zone1");
  for (const char* name : {"ZoneBC", "GridCoordinates"}) {
    EXPECT_EQ(image.child(zone, name).role, wire::Role::left_out);
    EXPECT_TRUE(image.child(zone, name).children.empty());
  }
  EXPECT_EQ(image.child(zone, "PYRA_5").role, wire::Role::group);
}

}  // namespace
}  // namespace sterna::io
