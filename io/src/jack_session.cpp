// SPDX-License-Identifier: MIT
#include "jack_session.h"

#include <mutex>

namespace knotwave::io {
namespace {

struct Tickets {
  std::mutex mutex;
  int out = 0;
  bool has_server_gone = false;
};

Tickets& tickets() {
  static auto* const all = new Tickets;  // outlives the threads of libraries
  return *all;
}

}  // namespace

std::unique_ptr<JackTicket> JackTicket::take() {
  const std::lock_guard lock(tickets().mutex);
  if (tickets().has_server_gone) return nullptr;
  ++tickets().out;
  return std::unique_ptr<JackTicket>(new JackTicket);
}

void JackTicket::server_has_gone() noexcept {
  const std::lock_guard lock(tickets().mutex);
  tickets().has_server_gone = tickets().out > 0;
}

bool JackTicket::has_server_gone() noexcept {
  const std::lock_guard lock(tickets().mutex);
  return tickets().has_server_gone;
}

JackTicket::~JackTicket() {
  const std::lock_guard lock(tickets().mutex);
  if (--tickets().out == 0) tickets().has_server_gone = false;
}

}  // namespace knotwave::io
