// Access control of the workbench server: valid requests are answered, all others are refused.
#include "scripting/view/page_server.h"

#include <gtest/gtest.h>

#include <atomic>
#include <random>
#include <thread>

#include "tests/scripting/view/raw_http.h"
#include "tests/support/error_of.h"

namespace sterna::scripting {
namespace {

using test::body_of;
using test::exchange_bytes;
using test::get_request;
using test::post_request;
using test::status_of;

class PageServerTest : public testing::Test {
 protected:
  std::atomic<int> n_answered_ = 0;
  PageServer server_{0, [this](const PageRequest& request) {
                       ++n_answered_;
                       return PageAnswer{.body = std::make_shared<const std::string>((request.is_post ? "post " : "get ") + request.name + " " +
                                                                                     request.value("a") + " " + request.body)};
                     }};
  const int port_ = test::parts_of(server_.address()).first;
  const std::string secret_ = test::parts_of(server_.address()).second;

  int status_for(const std::string& bytes) const { return status_of(exchange_bytes(port_, bytes)); }
  /// Expects that the request is refused and that the next valid request is answered.
  void expect_refused(const std::string& bytes, const std::vector<int>& allowed, const char* what) {
    const int n_before = n_answered_;
    const int status = status_for(bytes);
    EXPECT_NE(std::find(allowed.begin(), allowed.end(), status), allowed.end()) << what << ": " << status;
    EXPECT_EQ(n_answered_, n_before) << what;
    EXPECT_EQ(status_for(get_request(port_, secret_)), 200) << what;
  }
};

TEST_F(PageServerTest, AnswersThoseWhoKnowTheSecret) {
  EXPECT_EQ(secret_.size(), 34u);
  EXPECT_EQ(body_of(exchange_bytes(port_, get_request(port_, secret_))), "get   ");
  EXPECT_EQ(body_of(exchange_bytes(port_, get_request(port_, secret_ + "state?a=5"))), "get state 5 ");
  EXPECT_EQ(body_of(exchange_bytes(port_, post_request(port_, secret_ + "values", "{}"))), "post values  {}");
  // Through a tunnel the port differs.
  EXPECT_EQ(status_for("GET " + secret_ + " HTTP/1.1\r\nHost: localhost:9000\r\nOrigin: http://localhost:9000\r\n\r\n"), 200);
  const std::string answer = exchange_bytes(port_, get_request(port_, secret_));
  for (const char* header : {"X-Frame-Options: DENY", "Cache-Control: no-store", "X-Content-Type-Options: nosniff", "Referrer-Policy: no-referrer"})
    EXPECT_NE(answer.find(header), std::string::npos) << header;
  EXPECT_EQ(answer.find("Access-Control-Allow"), std::string::npos);
}

TEST_F(PageServerTest, HasAnotherSecretEachTime) {
  const PageServer other(0, [](const PageRequest&) { return PageAnswer{}; });
  EXPECT_NE(test::parts_of(other.address()).second, secret_);
}

TEST_F(PageServerTest, RefusesWrongSecrets) {
  for (const std::string& path : std::vector<std::string>{"/", "", "/state", "/" + std::string(32, '0') + "/", secret_.substr(0, 33), secret_.substr(0, 20),
                                                          "/x" + secret_, "//" + secret_.substr(1)})
    expect_refused(get_request(port_, path), {400, 404, 0}, path.c_str());
}

TEST_F(PageServerTest, RefusesForeignHosts) {
  for (const char* host : {"evil.example", "evil.example:80", "127.0.0.1.evil.example", "localhost.evil.example:80", "127.0.0.1:", "127.0.0.1:80:80",
                           "[::1]:80", "0.0.0.0", "127.0.0.1:99999999", ""})
    expect_refused("GET " + secret_ + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n", {403, 400, 0}, host);
  expect_refused("GET " + secret_ + " HTTP/1.1\r\n\r\n", {403, 400, 0}, "no host");
  expect_refused("GET " + secret_ + " HTTP/1.1\r\nHost: 127.0.0.1\r\nHost: evil.example\r\n\r\n", {403, 400, 0}, "two hosts");
}

TEST_F(PageServerTest, RefusesForeignOrigins) {
  for (const char* origin : {"http://evil.example", "null", "https://127.0.0.1", "http://127.0.0.1:1", "http://127.0.0.1.evil.example"})
    expect_refused(get_request(port_, secret_, "Origin: " + std::string(origin) + "\r\n"), {403}, origin);
  expect_refused(get_request(port_, secret_, "Sec-Fetch-Site: cross-site\r\n"), {403}, "cross-site");
  expect_refused(post_request(port_, secret_ + "values", "{}", ""), {403}, "a form of another page");
  expect_refused(post_request(port_, secret_ + "values", "{}", "X-Sterna: 2\r\n"), {403}, "wrong header");
}

TEST_F(PageServerTest, RefusesPathsThatLeaveThePage) {
  for (const char* path : {"../etc/passwd", "..%2f..%2fetc%2fpasswd", "%2e%2e/x", "state/../../x", "state%00", "a.b", "state/", "//etc/passwd", "C:\\x", "a b",
                           "state;x", "%73tate", "state%3f", "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"})
    expect_refused(get_request(port_, secret_ + path), {400, 404, 0}, path);
  EXPECT_EQ(status_for(get_request(port_, "/x/.." + secret_)), 404);
}

TEST_F(PageServerTest, RefusesOtherMethods) {
  for (const char* method : {"PUT", "DELETE", "OPTIONS", "PATCH", "HEAD", "CONNECT", "TRACE", "PRI", "get", "FETCH"})
    expect_refused(std::string(method) + " " + secret_ + "state HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port_) + "\r\n\r\n", {400, 403, 404, 405, 0},
                   method);
}

TEST_F(PageServerTest, RefusesWhatIsTooLarge) {
  const std::string much(k_most_body_bytes + 1, 'x');
  expect_refused(post_request(port_, secret_ + "values", much), {413, 400, 0}, "a body");
  expect_refused("POST " + secret_ + "values HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Sterna: 1\r\nContent-Length: 99999999999999999999\r\n\r\nx", {413, 400, 0},
                 "a length");
  std::string chunks = "POST " + secret_ + "values HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Sterna: 1\r\nTransfer-Encoding: chunked\r\n\r\n";
  for (int i = 0; i < 400; ++i) chunks += "1000\r\n" + std::string(0x1000, 'x') + "\r\n";
  expect_refused(chunks, {413, 400, 0}, "chunks without end");
  expect_refused(get_request(port_, secret_, "X: " + std::string(k_most_head_bytes, 'y') + "\r\n"), {400, 0}, "a header");
  std::string headers;
  for (int i = 0; i < 20000; ++i) headers += "X" + std::to_string(i) + ": y\r\n";
  expect_refused(get_request(port_, secret_, headers), {400, 0}, "headers without end");
  expect_refused(get_request(port_, secret_ + "?" + std::string(9000, 'a')), {414, 400, 0}, "an address");
}

TEST_F(PageServerTest, OutlivesBrokenRequests) {
  const std::string good = get_request(port_, secret_ + "state?a=1");
  for (const std::string& bytes : std::vector<std::string>{
           "\r\n\r\n", "GET\r\n\r\n", "GET / HTTP/9.9\r\n\r\n", std::string(64, '\0') + "\r\n\r\n", "GET " + secret_ + " HTTP/1.1\r\nHost 127.0.0.1\r\n\r\n",
           "GET " + secret_ + " HTTP/1.1\r\nHost: 127.0.0.1\r\nRange: bytes=" + std::string(7000, '9') + "-\r\n\r\n",
           "GET " + secret_ + " HTTP/1.1\r\nHost: 127.0.0.1\r\nRange: bytes=0-0," + std::string(7000, '1') + "\r\n\r\n",
           "POST " + secret_ +
               "values HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Sterna: 1\r\nContent-Type: multipart/form-data; boundary=x\r\nContent-Length: 5\r\n\r\n--x--",
           "POST " + secret_ + "values HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Sterna: 1\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n\r\n"}) {
    exchange_bytes(port_, bytes);
    EXPECT_EQ(status_for(good), 200);
  }
  // Valid requests with a few bytes changed are refused or answered, and never end the server. The seed is fixed.
  std::mt19937 random(7);
  for (int i = 0; i < 300; ++i) {
    std::string bytes = i % 2 ? good : post_request(port_, secret_ + "values", "{\"a\": 1}");
    for (int k = 0; k < 3; ++k) bytes[random() % (bytes.size() - 4)] = static_cast<char>(random());
    const int socket_side = static_cast<int>(random() % 3);
    if (socket_side == 0) bytes.resize(bytes.size() / 2);
    bytes += "\r\n\r\n";
    exchange_bytes(port_, bytes);
  }
  EXPECT_EQ(status_for(good), 200);
}

TEST_F(PageServerTest, AnswersManyAtATime) {
  std::vector<std::thread> threads;
  std::atomic<int> n_good = 0;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back([&] {
      for (int k = 0; k < 20; ++k) n_good += status_for(get_request(port_, secret_ + "state")) == 200;
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(n_good, 160);
}

TEST(PageServer, SaysThatAPortIsTaken) {
  const PageServer first(0, [](const PageRequest&) { return PageAnswer{}; });
  const int port = test::parts_of(first.address()).first;
  test::expect_error(ErrorCode::bad_argument, "port is not available", [&] { const PageServer second(port, [](const PageRequest&) { return PageAnswer{}; }); });
}

}  // namespace
}  // namespace sterna::scripting
