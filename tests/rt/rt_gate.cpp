// SPDX-License-Identifier: MIT
#include "rt_gate.h"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdlib>

#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

// The sanitizer's functions, there only when its runtime is linked.
extern "C" {
__attribute__((weak)) void __rtsan_init();
__attribute__((weak)) void __rtsan_realtime_enter();
__attribute__((weak)) void __rtsan_realtime_exit();
}

namespace knotwave::rt {
namespace {

volatile sig_atomic_t armed = 0;
volatile sig_atomic_t refused = 0;
volatile sig_atomic_t first_refused = -1;

/// A refused call counts while the gate is armed and returns ENOSYS; the thread's own end, which
/// calls the system as well, does not count.
void on_refused_call(int, siginfo_t* info, void* context) {
  if (armed != 0) {
    if (refused == 0) first_refused = info->si_syscall;
    refused = refused + 1;
  }
#if defined(__x86_64__)
  static_cast<ucontext_t*>(context)->uc_mcontext.gregs[REG_RAX] = -ENOSYS;
#elif defined(__aarch64__)
  static_cast<ucontext_t*>(context)->uc_mcontext.regs[0] = static_cast<unsigned long long>(-ENOSYS);
#else
  static_cast<void>(context);
#endif
}

/// Refuses every system call of this thread but the few the gate itself needs, and futexes where
/// they are listed.
bool install_filter(bool may_use_futexes) {
#if !defined(__x86_64__) && !defined(__aarch64__)
  return false;
#endif
  const std::array allowed = {SYS_rt_sigreturn, SYS_exit, SYS_exit_group, SYS_getrusage,
                              may_use_futexes ? SYS_futex : SYS_exit};
  std::array<sock_filter, allowed.size() + 3> program{};
  program[0] = BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr));
  for (std::size_t i = 0; i < allowed.size(); ++i) {
    const auto to_allow = static_cast<__u8>(allowed.size() - i);
    program[i + 1] =
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<__u32>(allowed[i]), to_allow, 0);
  }
  program[allowed.size() + 1] = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP);
  program[allowed.size() + 2] = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
  const sock_fprog filter = {static_cast<unsigned short>(program.size()), program.data()};
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return false;
  return ::syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0, &filter) == 0;
}

}  // namespace

std::string GateReport::findings() const {
  std::string text;
  if (system_calls > 0) {
    text += std::to_string(system_calls) + " system calls, the first is number " +
            std::to_string(first_call) + "; ";
  }
  if (voluntary_waits > 0) text += std::to_string(voluntary_waits) + " voluntary waits; ";
  if (page_faults > 0) text += std::to_string(page_faults) + " page faults; ";
  return text;
}

namespace {

GateReport run_sanitized(const std::function<void()>& work) {
  GateReport report;
  report.watched = __rtsan_realtime_enter != nullptr;
  if (report.watched) __rtsan_realtime_enter();
  work();
  if (report.watched) __rtsan_realtime_exit();
  return report;
}

GateReport run_filtered(const std::function<void()>& work, bool may_use_futexes) {
  GateReport report;
  rusage before{};
  rusage after{};
  ::getrusage(RUSAGE_THREAD, &before);  // once before, so that what it touches is there
  report.watched = install_filter(may_use_futexes);
  ::getrusage(RUSAGE_THREAD, &before);
  armed = 1;
  work();
  armed = 0;
  ::getrusage(RUSAGE_THREAD, &after);
  if (!may_use_futexes) report.voluntary_waits = after.ru_nvcsw - before.ru_nvcsw;
  report.page_faults = after.ru_minflt - before.ru_minflt + after.ru_majflt - before.ru_majflt;
  return report;
}

struct GatedThread {
  Gate gate;
  const std::function<void()>& work;
  const std::function<void()>& prepare;
  GateReport report;
};

/// Ends at the kernel, past what the C library does at a thread's end: behind the filter that would
/// abort where another thread holds the lock of the memory it shares with this one.
void* run_gated(void* context) {
  auto& thread = *static_cast<GatedThread*>(context);
  thread.prepare();
  if (thread.gate == Gate::sanitizer) {
    thread.report = run_sanitized(thread.work);
    return nullptr;
  }
  thread.report = run_filtered(thread.work, thread.gate == Gate::parallel);
  ::syscall(SYS_exit, 0);
  return nullptr;
}

}  // namespace

bool join_parallel_gate() { return install_filter(true); }

GateReport run_in_gate(Gate gate, const std::function<void()>& work,
                       const std::function<void()>& prepare) {
  struct sigaction action {};
  action.sa_sigaction = on_refused_call;
  action.sa_flags = SA_SIGINFO;
  ::sigaction(SIGSYS, &action, nullptr);
  if (__rtsan_init != nullptr) __rtsan_init();
  refused = 0;
  first_refused = -1;
  GatedThread gated{gate, work, prepare, {}};
  pthread_t thread{};
  if (::pthread_create(&thread, nullptr, run_gated, &gated) != 0) std::abort();
  ::pthread_join(thread, nullptr);
  gated.report.system_calls = refused;
  gated.report.first_call = first_refused;
  return gated.report;
}

}  // namespace knotwave::rt
