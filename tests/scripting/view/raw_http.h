// Sends raw bytes to a port and returns the answer, for requests that no library would send.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

namespace sterna::test {

/// Returns port and secret of an address: {8123, "/5f0c/"} for "http://127.0.0.1:8123/5f0c/".
inline std::pair<int, std::string> parts_of(const std::string& address) {
  const std::size_t colon = address.rfind(':'), slash = address.find('/', colon);
  return {std::stoi(address.substr(colon + 1, slash - colon - 1)), address.substr(slash)};
}

/// Sends the bytes and reads to the end of the answer; empty if the connection ends without an answer.
inline std::string exchange_bytes(int port, const std::string& bytes) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
  if (connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
    close(socket);
    return "no connection";
  }
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t n = send(socket, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (n <= 0) break;
    sent += static_cast<std::size_t>(n);
  }
  std::string answer;
  char buffer[65536];
  for (ssize_t n; (n = recv(socket, buffer, sizeof buffer, 0)) > 0;) answer.append(buffer, static_cast<std::size_t>(n));
  close(socket);
  return answer;
}

/// Returns the status code, e.g. 200 for "HTTP/1.1 200 OK"; 0 if the connection ended.
inline int status_of(const std::string& answer) { return answer.starts_with("HTTP/1.") && answer.size() > 12 ? std::stoi(answer.substr(9, 3)) : 0; }
inline std::string body_of(const std::string& answer) {
  const std::size_t end = answer.find("\r\n\r\n");
  return end == std::string::npos ? std::string() : answer.substr(end + 4);
}

inline std::string get_request(int port, const std::string& path, const std::string& more = {}) {
  return "GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n" + more + "\r\n";
}
inline std::string post_request(int port, const std::string& path, const std::string& body, const std::string& more = "X-Sterna: 1\r\n") {
  return "POST " + path + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
         "\r\nContent-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" + more + "\r\n" + body;
}

}  // namespace sterna::test
