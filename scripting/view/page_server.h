// Serves one page to one user, on 127.0.0.1 only, below a secret in the address. The only component that uses cpp-httplib.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace sterna::scripting {

struct PageRequest {
  bool is_post = false;
  std::string name;                          ///< the part of the path after the secret: "" for the page itself, or a name such as "state"
  std::map<std::string, std::string> query;  ///< after "?"
  std::string body;                          ///< body of a POST request
  std::string value(const std::string& key) const {
    const auto found = query.find(key);
    return found == query.end() ? std::string() : found->second;
  }
};

struct PageAnswer {
  int status = 200;
  std::string_view type = "application/json";  ///< media type of the body
  std::shared_ptr<const std::string> body;
};

/// Maximum size of a request; larger requests are refused before they are read.
inline constexpr std::size_t k_most_body_bytes = 256 * 1024;
inline constexpr std::size_t k_most_head_bytes = 16 * 1024;

/// Answers requests from its own threads during its lifetime. It refuses (403, 404, 405, 413, or a closed connection) requests that
/// - do not begin with the secret, or name another host than 127.0.0.1 or localhost (a name that some page has redirected to this machine),
/// - come from a page of another origin, or post without the header `X-Sterna: 1`, which pages of other origins cannot send,
/// - are neither GET nor POST, or have a name that contains other characters than letters, digits and underscores: no path ever reaches the disk,
/// - are too large or arrive too slowly (k_most_head_bytes, k_most_body_bytes, k_most_seconds of page_server.cpp).
class PageServer {
 public:
  using Answer = std::function<PageAnswer(const PageRequest&)>;

  /// \param port 0: any free port. \param answer called from several threads; it may wait for up to half a minute
  /// \throws Error(bad_argument) if the port is taken
  PageServer(int port, Answer answer);
  /// Waits until all answers have been given. Threads that wait in `answer` must be woken first.
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  /// Returns "http://127.0.0.1:8123/5f0c.../", with the secret.
  const std::string& address() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace sterna::scripting
