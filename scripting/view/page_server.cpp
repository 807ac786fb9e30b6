#include "scripting/view/page_server.h"

#include <fcntl.h>
#include <httplib.h>
#include <poll.h>
#include <sys/random.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <thread>

#include "geom/base/error.h"

namespace sterna::scripting {
namespace {

using Clock = std::chrono::steady_clock;

/// Maximum number of simultaneous requests. A page keeps one waiting and loads pictures at the same time, so this is enough for a few pages.
constexpr std::size_t k_threads = 16;
constexpr std::size_t k_secret_bytes = 16;
/// A request must be complete within this time, regardless of its transfer rate.
constexpr std::chrono::seconds k_most_seconds{10};
/// Time limit of an answer without progress, ms. It is long, because megabytes may pass through a slow tunnel.
constexpr int k_stall_ms = 30'000;

std::string new_secret() {
  std::array<unsigned char, k_secret_bytes> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw Error({.code = ErrorCode::internal, .attempted = "creating the address of the page", .problem = "the system does not provide random bytes"});
  std::string text;
  for (const unsigned char byte : bytes) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

/// Compares in constant time, so that a guess with a correct beginning takes no longer than any other.
bool is_same_secret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

/// Returns true if a Host header refers to this machine. Any port is accepted, because it may be that of a tunnel.
bool is_local_host(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  const std::string_view name = host.substr(0, colon), port = colon == std::string_view::npos ? std::string_view("80") : host.substr(colon + 1);
  return (name == "127.0.0.1" || name == "localhost") && !port.empty() && port.size() <= 5 &&
         std::all_of(port.begin(), port.end(), [](unsigned char c) { return std::isdigit(c); });
}

bool is_plain_name(std::string_view name) {
  constexpr std::size_t k_longest = 32;
  return name.size() <= k_longest && std::all_of(name.begin(), name.end(), [](unsigned char c) { return c == '_' || std::isalnum(c); });
}

/// A connection that ends if a request exceeds the size or time limit. The library itself has no such limits.
class Connection final : public httplib::Stream {
 public:
  explicit Connection(socket_t socket) : socket_(socket), end_(Clock::now() + k_most_seconds) {}

  bool is_readable() const override { return wait(POLLIN, left_ms()); }
  bool is_writable() const override { return wait(POLLOUT, k_stall_ms); }
  ssize_t read(char* bytes, size_t n) override {
    if (n_read_ >= k_most_head_bytes + k_most_body_bytes || !is_readable()) return -1;
    const ssize_t n_new = recv(socket_, bytes, std::min(n, k_most_head_bytes + k_most_body_bytes - n_read_), 0);
    if (n_new > 0) n_read_ += static_cast<std::size_t>(n_new);
    return n_new;
  }
  ssize_t write(const char* bytes, size_t n) override { return is_writable() ? send(socket_, bytes, n, MSG_NOSIGNAL) : -1; }
  void get_remote_ip_and_port(std::string& ip, int& port) const override {
    ip = "127.0.0.1";
    port = 0;
  }
  void get_local_ip_and_port(std::string& ip, int& port) const override { get_remote_ip_and_port(ip, port); }
  socket_t socket() const override { return socket_; }

 private:
  int left_ms() const {
    return static_cast<int>(std::max<std::int64_t>(0, std::chrono::duration_cast<std::chrono::milliseconds>(end_ - Clock::now()).count()));
  }
  bool wait(short event, int milliseconds) const {
    pollfd entry{socket_, event, 0};
    return poll(&entry, 1, milliseconds) > 0;
  }

  socket_t socket_;
  Clock::time_point end_;
  std::size_t n_read_ = 0;
};

/// Tests the size of a request's head. The library then reads the head line by line, without a limit on the number of lines.
bool has_short_head(socket_t socket) {
  std::string head(k_most_head_bytes, '\0');
  const Clock::time_point end = Clock::now() + k_most_seconds;
  std::size_t n_before = 0;
  for (;;) {
    const ssize_t n = recv(socket, head.data(), head.size(), MSG_PEEK | MSG_DONTWAIT);
    if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR)) return false;
    const std::size_t n_now = n > 0 ? static_cast<std::size_t>(n) : 0;
    if (std::string_view(head.data(), n_now).find("\r\n\r\n") != std::string_view::npos) return true;
    if (n_now == head.size() || Clock::now() > end) return false;
    // poll() returns immediately while bytes that were already seen are available.
    pollfd entry{socket, POLLIN | POLLRDHUP, 0};
    poll(&entry, 1, n_now > n_before || n_now == 0 ? 100 : 0);
    if ((entry.revents & POLLRDHUP) != 0 && n_now == n_before) return false;  // no more bytes will arrive
    if (n_now > 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    n_before = n_now;
  }
}

class Server final : public httplib::Server {
 private:
  /// Handles one request per connection. For browsers on the same machine the loss of speed is negligible.
  bool process_and_close_socket(socket_t socket) override {
    fcntl(socket, F_SETFD, FD_CLOEXEC);  // prevents inheritance by workers
    if (has_short_head(socket)) {
      Connection connection(socket);
      bool is_closed = false;
      process_request(connection, true, is_closed, nullptr);
    }
    shutdown(socket, SHUT_RDWR);
    close(socket);
    return true;
  }
};

void give(httplib::Response& response, const PageAnswer& answer) {
  response.status = answer.status;
  if (!answer.body || answer.body->empty()) return response.set_content("", std::string(answer.type));
  // The bytes are shared and not copied, because pictures have tens of megabytes.
  response.set_content_provider(answer.body->size(), std::string(answer.type),
                                [body = answer.body](size_t from, size_t n, httplib::DataSink& sink) { return sink.write(body->data() + from, n); });
}

void refuse(httplib::Response& response, int status) {
  response.status = status;
  response.set_content("refused\n", "text/plain");
}

}  // namespace

struct PageServer::Parts {
  Answer answer;
  std::string secret, address;
  Server server;
  std::thread thread;

  /// Returns 0 if the request may be answered, else the status of the refusal; sets the requested name.
  int examine(const httplib::Request& request, std::string& name) const {
    const std::string prefix = "/" + secret + "/";
    if (request.get_header_value_count("Host") != 1 || !is_local_host(request.get_header_value("Host"))) return 403;
    const std::string path = request.target.substr(0, request.target.find('?'));  // the path as sent, not decoded
    if (path.size() < prefix.size() || !is_same_secret(std::string_view(path).substr(0, prefix.size()), prefix)) return 404;
    if (request.has_header("Origin") && request.get_header_value("Origin") != "http://" + request.get_header_value("Host")) return 403;
    if (const std::string site = request.get_header_value("Sec-Fetch-Site"); !site.empty() && site != "same-origin" && site != "none") return 403;
    if (request.method != "GET" && request.method != "POST") return 405;
    if (request.method == "POST" && request.get_header_value("X-Sterna") != "1") return 403;
    name = path.substr(prefix.size());
    return is_plain_name(name) ? 0 : 404;
  }

  void respond(const httplib::Request& request, httplib::Response& response, const std::string& name) const {
    PageRequest of_page{.is_post = request.method == "POST", .name = name, .query = {}, .body = request.body};
    for (const auto& [key, value] : request.params) of_page.query.emplace(key, value);
    give(response, answer(of_page));
  }
};

PageServer::PageServer(int port, Answer answer) : parts_(std::make_unique<Parts>()) {
  Parts& parts = *parts_;
  parts.answer = std::move(answer);
  parts.secret = new_secret();
  parts.server.new_task_queue = [] { return new httplib::ThreadPool(k_threads); };
  // SO_REUSEPORT is not set, because another process could then share the port.
  parts.server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  parts.server.set_payload_max_length(k_most_body_bytes);
  parts.server.set_tcp_nodelay(true);
  parts.server.set_default_headers({{"Cache-Control", "no-store"},
                                    {"X-Content-Type-Options", "nosniff"},
                                    {"X-Frame-Options", "DENY"},
                                    {"Referrer-Policy", "no-referrer"},
                                    {"Cross-Origin-Resource-Policy", "same-origin"},
                                    {"Cross-Origin-Opener-Policy", "same-origin"}});
  using Handled = httplib::Server::HandlerResponse;
  parts.server.set_pre_routing_handler([&parts](const httplib::Request& request, httplib::Response& response) {
    std::string name;
    if (const int status = parts.examine(request, name); status != 0) refuse(response, status);
    else if (request.method == "POST") return Handled::Unhandled;  // POST requests are answered after their body has been read
    else parts.respond(request, response, name);
    return Handled::Handled;
  });
  parts.server.Post(".*", [&parts](const httplib::Request& request, httplib::Response& response) {
    std::string name;
    if (const int status = parts.examine(request, name); status != 0) return refuse(response, status);
    parts.respond(request, response, name);
  });
  const int bound = port == 0 ? parts.server.bind_to_any_port("127.0.0.1") : parts.server.bind_to_port("127.0.0.1", port) ? port : -1;
  if (bound <= 0)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "serving the page on port " + std::to_string(port),
                 .problem = "the port is not available: another program uses it",
                 .hint = "omit --port to use a free port"});
  parts.address = "http://127.0.0.1:" + std::to_string(bound) + "/" + parts.secret + "/";
  parts.thread = std::thread([&parts] { parts.server.listen_after_bind(); });
}

PageServer::~PageServer() {
  while (!parts_->server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));  // an earlier stop() would be lost
  parts_->server.stop();
  parts_->thread.join();
}

const std::string& PageServer::address() const { return parts_->address; }

}  // namespace sterna::scripting
