// libFuzzer target for code without a file format: predicates, planar and spatial triangulations, envelopes, script tables, workbench requests. For any bytes,
// either the results agree with a second method or the input is refused by an Error. STERNA_FUZZ names the target, as for reader_fuzz; --list and --seeds also
// work as there. Built by the preset "fuzz"; run by tests/fuzz/run_fuzzers.
#include <fuzzer/FuzzedDataProvider.h>
#include <gmpxx.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/error.h"
#include "geom/delaunay/check_triangulation.h"
#include "geom/delaunay/planar.h"
#include "geom/math/insphere.h"
#include "geom/math/intersect.h"
#include "geom/math/measures.h"
#include "geom/math/predicates.h"
#include "geom/tets/bulk_insert.h"
#include "scripting/lua/table_reader.h"
#include "scripting/view/page_server.h"
#include "tests/geom/tets/grids.h"
#include "tests/support/test_shapes.h"
#include "volmesh/case/mesh_case.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/certificate.h"

namespace {

using namespace sterna;

[[noreturn]] void report(const std::string& what) {
  std::fprintf(stderr, "FINDING: %s\n", what.c_str());
  std::abort();
}

const RunContext& quiet_context() {
  static const RunContext context({.threads = 1});
  return context;
}

/// Returns a coordinate from a small set of values, moved by a few units in the last place, so that points coincide and lie on lines and spheres. Uses 1e-30
/// near zero because the predicates are exact from 1e-42 on.
double coordinate(FuzzedDataProvider& bytes) {
  double x = bytes.ConsumeIntegralInRange<int>(-8, 8);
  if (bytes.ConsumeIntegralInRange<int>(0, 3) == 0) x /= 3.0;
  const int n_units = bytes.ConsumeIntegralInRange<int>(-2, 2);
  if (x == 0.0) return n_units * 1e-30;
  for (int i = n_units; i != 0; i += i > 0 ? -1 : 1) x = std::nextafter(x, i > 0 ? 1e300 : -1e300);
  return x;
}

Vec3 location(FuzzedDataProvider& bytes) {
  const double x = coordinate(bytes), y = coordinate(bytes), z = coordinate(bytes);
  return {x, y, z};
}

// ---- predicates against rational arithmetic ---------------------------------------------------------------------------------------------------

using Exact = std::array<mpq_class, 3>;
Exact exact(const Vec3& a) { return {mpq_class(a.x), mpq_class(a.y), mpq_class(a.z)}; }
Exact operator-(const Exact& a, const Exact& b) { return {mpq_class(a[0] - b[0]), mpq_class(a[1] - b[1]), mpq_class(a[2] - b[2])}; }
mpq_class dot(const Exact& a, const Exact& b) { return mpq_class(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]); }
mpq_class determinant(const Exact& a, const Exact& b, const Exact& c) {
  return mpq_class(a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]));
}

void fuzz_predicates(FuzzedDataProvider& bytes) {
  std::array<Vec3, 5> p;
  for (Vec3& x : p) x = location(bytes);
  std::array<Exact, 4> from_last;
  for (std::size_t k = 0; k < 4; ++k) from_last[k] = exact(p[k]) - exact(p[4]);
  const Exact ab = exact(p[1]) - exact(p[0]), ac = exact(p[2]) - exact(p[0]), ad = exact(p[3]) - exact(p[0]);
  const int side = sgn(determinant(ab, ac, ad));
  if (orient3d(p[0], p[1], p[2], p[3]) != side) report("orient3d");
  mpq_class sphere = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const mpq_class minor = determinant(from_last[(k + 1) % 4], from_last[(k + 2) % 4], from_last[(k + 3) % 4]);
    sphere += (k % 2 == 0 ? 1 : -1) * dot(from_last[k], from_last[k]) * minor;
  }
  if (insphere(p[0], p[1], p[2], p[3], p[4]) != sgn(sphere)) report("insphere");
  const auto flat = [](const Vec3& x) { return Vec2{x.x, x.y}; };
  if (orient2d(flat(p[0]), flat(p[1]), flat(p[2])) != sgn(mpq_class(ab[0] * ac[1] - ab[1] * ac[0]))) report("orient2d");
  std::array<Exact, 3> lifted;
  for (std::size_t k = 0; k < 3; ++k) {
    const Exact d = exact(p[k]) - exact(p[3]);
    lifted[k] = {d[0], d[1], mpq_class(d[0] * d[0] + d[1] * d[1])};
  }
  if (incircle(flat(p[0]), flat(p[1]), flat(p[2]), flat(p[3])) != sgn(determinant(lifted[0], lifted[1], lifted[2]))) report("incircle");
}

void fuzz_intersections(FuzzedDataProvider& bytes) {
  std::array<Vec3, 6> p;
  for (Vec3& x : p) x = location(bytes);
  const auto meet = [&](std::array<std::size_t, 3> a, std::array<std::size_t, 3> b) {
    return triangles_intersect({p[a[0]], p[a[1]], p[a[2]]}, {p[b[0]], p[b[1]], p[b[2]]});
  };
  const bool is = meet({0, 1, 2}, {3, 4, 5});
  std::array<std::size_t, 3> a = {0, 1, 2};
  do {
    std::array<std::size_t, 3> b = {3, 4, 5};
    do {
      if (meet(a, b) != is || meet(b, a) != is) report("triangles_intersect depends on the order of corners");
    } while (std::ranges::next_permutation(b).found);
  } while (std::ranges::next_permutation(a).found);
  // Two triangles with a common corner meet; so do two triangles of which one has a corner on the other.
  if (!triangles_intersect({p[0], p[1], p[2]}, {p[0], p[4], p[5]})) report("triangles with a common corner do not meet");
}

// ---- triangulations --------------------------------------------------------------------------------------------------------------------------

void fuzz_plane(FuzzedDataProvider& bytes) {
  std::vector<Vec2> points(bytes.ConsumeIntegralInRange<std::size_t>(0, 40));
  for (Vec2& p : points) p = {coordinate(bytes), coordinate(bytes)};
  std::vector<delaunay::Segment> segments(bytes.ConsumeIntegralInRange<std::size_t>(0, 12));
  const auto n = static_cast<std::uint32_t>(points.size());
  for (delaunay::Segment& s : segments)
    s = {bytes.ConsumeIntegralInRange<std::uint32_t>(0, n), bytes.ConsumeIntegralInRange<std::uint32_t>(0, n), bytes.ConsumeBool()};
  const auto extent = bytes.ConsumeBool() ? delaunay::Extent::hull : delaunay::Extent::inside;
  try {
    const delaunay::PlanarTriangulation made = triangulate_plane(points, segments, extent, quiet_context());
    const delaunay::TriangulationCheck check = check_triangulation(made.mesh);
    if (!check.is_valid() || check.n_not_delaunay > 0) report(check.text());
  } catch (const Error& error) {
    if (error.code() != ErrorCode::self_intersection && error.code() != ErrorCode::bad_argument) report(error.what());
  }
}

void fuzz_space(FuzzedDataProvider& bytes) {
  const test::TetSoup cube = test::cube_of_tets(bytes.ConsumeIntegralInRange<std::uint32_t>(1, 2));
  tets::TetMesh mesh = tets::connect(cube.points, cube.tetrahedra, quiet_context());
  std::vector<tets::Seed> seeds(bytes.ConsumeIntegralInRange<std::size_t>(0, 40));
  for (tets::Seed& seed : seeds) {
    const Vec3 p = location(bytes);
    seed.position = Vec3{0.5, 0.5, 0.5} + p / 16.0;
  }
  tets::BulkInserter inserter(mesh, quiet_context());
  inserter.find_starts(seeds, quiet_context());
  inserter.insert(seeds, quiet_context());
  if (!test::is_sound(mesh)) report("the mesh of tetrahedra is not sound");
  if (std::abs(test::volume_of(mesh) - 1.0) > 1e-12) report("the tetrahedra do not fill the cube");
}

// ---- the envelope ----------------------------------------------------------------------------------------------------------------------------

void fuzz_envelope(FuzzedDataProvider& bytes) {
  TriMesh wall = bytes.ConsumeBool() ? test::cube(bytes.ConsumeIntegralInRange<int>(1, 3)) : test::sphere(bytes.ConsumeIntegralInRange<int>(1, 3));
  const Vec3 stretch = {bytes.ConsumeIntegralInRange<int>(1, 20) / 4.0, bytes.ConsumeIntegralInRange<int>(1, 20) / 4.0,
                        bytes.ConsumeIntegralInRange<int>(1, 20) / 4.0};
  const double noise = bytes.ConsumeIntegralInRange<int>(0, 40) / 100.0;
  for (Point& p : wall.points) {
    const auto moved = [&](double x) { return x + noise * bytes.ConsumeIntegralInRange<int>(-16, 16) / 16.0; };
    const double x = moved(p.x), y = moved(p.y), z = moved(p.z);
    p = {stretch.x * x, stretch.y * y, stretch.z * z};
  }
  for (const TriangleId t : wall.triangles.ids()) {
    const auto [a, b, c] = corners(wall, t);
    if (!(norm(area_vector(a, b, c)) > 1e-9)) return;  // refused before the envelope is made
  }
  volmesh::EnvelopeOptions options;
  options.layers = bytes.ConsumeIntegralInRange<int>(1, 20);
  options.first_height = std::pow(10.0, -bytes.ConsumeIntegralInRange<int>(1, 6));
  options.max_growth = 1.0 + bytes.ConsumeIntegralInRange<int>(1, 10) / 10.0;
  try {
    const volmesh::LayerBase base(wall, quiet_context());
    volmesh::Collider collider(base, nullptr, quiet_context());
    volmesh::require_clear_input(collider, quiet_context());
    const volmesh::Envelope envelope = volmesh::build_envelope(base, options, collider, quiet_context());
    const volmesh::EnvelopeCertificate proof = volmesh::certify_envelope(base, collider, envelope, quiet_context());
    if (!proof.is_proved()) report(volmesh::to_text(proof));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::self_intersection && error.code() != ErrorCode::bad_argument) report(error.what());
  }
}

// ---- scripts and requests --------------------------------------------------------------------------------------------------------------------

std::string name_of(FuzzedDataProvider& bytes, const OptionTable& options) {
  if (bytes.ConsumeBool()) return bytes.ConsumeRandomLengthString(24);
  const Option& option = options[bytes.ConsumeIntegralInRange<std::size_t>(0, options.size() - 1)];
  return std::string(bytes.ConsumeBool() ? option.name : option.stage);
}

std::shared_ptr<const scripting::ScriptTable> table_of(FuzzedDataProvider& bytes, const OptionTable& options, int depth);

scripting::ScriptValue value_of(FuzzedDataProvider& bytes, const OptionTable& options, int depth) {
  switch (bytes.ConsumeIntegralInRange<int>(0, 7)) {
    case 0: return std::monostate();
    case 1: return bytes.ConsumeBool();
    case 2: return bytes.ConsumeIntegral<std::int64_t>();
    case 3: return bytes.ConsumeFloatingPoint<double>();
    case 4: return bytes.ConsumeIntegralInRange<std::int64_t>(-2, 100);
    case 5: return bytes.ConsumeProbability<double>();
    case 6: return bytes.ConsumeRandomLengthString(32);
    default: break;
  }
  if (depth > 3) return std::monostate();
  return table_of(bytes, options, depth + 1);
}

std::shared_ptr<const scripting::ScriptTable> table_of(FuzzedDataProvider& bytes, const OptionTable& options, int depth) {
  scripting::ScriptTable table;
  for (int i = bytes.ConsumeIntegralInRange<int>(0, 3); i > 0; --i) table.items.push_back(value_of(bytes, options, depth));
  for (int i = bytes.ConsumeIntegralInRange<int>(0, 8); i > 0; --i) {
    const std::string name = name_of(bytes, options);
    table.fields[name] = value_of(bytes, options, depth);
  }
  return std::make_shared<const scripting::ScriptTable>(std::move(table));
}

void fuzz_table(FuzzedDataProvider& bytes) {
  volmesh::MeshOptions of_mesh;
  const OptionTable options = volmesh::options_of(of_mesh);
  const auto table = table_of(bytes, options, 0);
  try {
    scripting::TableReader reader(*table, "fuzz");
    reader.items();
    reader.read_options(options);
    reader.finish();
    for (const Option& option : options)
      if (reader.is_given(option.stage, option.name)) set_option(option, option.get());  // refuses values out of range
  } catch (const Error& error) {
    if (error.code() != ErrorCode::bad_argument && error.code() != ErrorCode::unknown_option) report(error.what());
    if (std::string_view(error.what()).empty()) report("a refusal without words");
  }
}

/// Sends these bytes over one connection, with "SECRET" replaced by the secret; returns the whole answer.
std::string requested(int port, const std::string& secret, std::string text) {
  for (std::size_t at = 0; (at = text.find("SECRET", at)) != std::string::npos; at += secret.size()) text.replace(at, 6, secret);
  const int connection = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connection < 0 || connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) report("no connection: the server is gone");
  std::string answer;
  if (send(connection, text.data(), text.size(), MSG_NOSIGNAL) >= 0) {
    shutdown(connection, SHUT_WR);
    std::array<char, 4096> part{};
    for (ssize_t n = 0; (n = recv(connection, part.data(), part.size(), 0)) > 0;) answer.append(part.data(), static_cast<std::size_t>(n));
  }
  close(connection);
  return answer;
}

void fuzz_requests(FuzzedDataProvider& bytes) {
  static const std::string body = "the page";
  static scripting::PageServer server(0, [](const scripting::PageRequest& request) {
    if (request.body.size() > scripting::k_most_body_bytes) report("a body that is too large reached the page");
    if (!std::ranges::all_of(request.name, [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_'; }))
      report("a name that may be a path: " + request.name);
    return scripting::PageAnswer{.body = std::make_shared<const std::string>(body)};
  });
  static const std::string& address = server.address();
  static const int port = std::atoi(address.c_str() + std::string_view("http://127.0.0.1:").size());
  static const std::string secret = [] {
    const std::size_t begin = address.find('/', 8) + 1;
    return address.substr(begin, address.find('/', begin) - begin);
  }();
  const std::string text = bytes.ConsumeRemainingBytesAsString();
  const std::string answer = requested(port, secret, text);
  if (answer.find(body) != std::string::npos && text.find("SECRET") == std::string::npos) report("an answer without the secret");
}

// ---- targets ---------------------------------------------------------------------------------------------------------------------------------

struct Target {
  std::string_view name;
  void (*run)(FuzzedDataProvider&);
  std::string_view seed;  ///< an initial input, in addition to random ones
};
constexpr std::array k_targets = {
    Target{"predicates", fuzz_predicates, ""},
    Target{"triangle intersections", fuzz_intersections, ""},
    Target{"triangulation of a plane", fuzz_plane, ""},
    Target{"points into tetrahedra", fuzz_space, ""},
    Target{"envelope", fuzz_envelope, ""},
    Target{"tables of scripts", fuzz_table, ""},
    Target{"requests of the workbench", fuzz_requests, "POST /SECRET/state?a=1 HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Sterna: 1\r\nContent-Length: 2\r\n\r\n{}"},
};

const Target& chosen_target() {
  const char* const name = std::getenv("STERNA_FUZZ");
  for (const Target& target : k_targets)
    if (name && target.name == name) return target;
  std::fprintf(stderr, "STERNA_FUZZ names no target; --list prints them\n");
  std::_Exit(2);
}

int write_seeds(const std::filesystem::path& folder) {
  constexpr int k_seeds = 16;
  std::uint64_t state = 88172645463325252u;  // xorshift64
  for (int i = 0; i < k_seeds; ++i) {
    std::ofstream file(folder / std::to_string(i), std::ios::binary);
    for (int k = 0; k < 64 << (i % 5); ++k) {
      state ^= state << 13, state ^= state >> 7, state ^= state << 17;
      file.put(static_cast<char>(state));
    }
  }
  if (chosen_target().seed.empty()) return k_seeds;
  std::ofstream(folder / "seed", std::ios::binary) << chosen_target().seed;
  return k_seeds + 1;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* n_arguments, char*** arguments) {
  const std::vector<std::string> words(*arguments + 1, *arguments + *n_arguments);
  if (words.empty() || !words[0].starts_with("--")) return 0;
  if (words[0] == "--list")
    for (const Target& target : k_targets) std::printf("%s\n", std::string(target.name).c_str());
  else if (words[0] == "--seeds" && words.size() >= 2) std::printf("%d\n", write_seeds(words[1]));
  std::fflush(stdout);
  std::_Exit(0);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t n) {
  static const Target& target = chosen_target();
  FuzzedDataProvider provider(bytes, n);
  target.run(provider);
  return 0;
}
