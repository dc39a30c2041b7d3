#include "bench/instructions/step_counter.h"

#ifdef __x86_64__
#include <csignal>
#include <ucontext.h>
#endif

namespace burnish {

#ifdef __x86_64__
namespace {

constexpr uint64_t kTrapFlag = 1u << 8;
volatile uint64_t steps, last_place;

void on_step(int, siginfo_t*, void* context)
{
    const auto place = static_cast<uint64_t>(static_cast<const ucontext_t*>(context)->uc_mcontext.gregs[REG_RIP]);
    if (place != last_place) // else another turn of a repeated instruction
        steps = steps + 1;
    last_place = place;
}

} // namespace

uint64_t count_steps(const std::function<void()>& work)
{
    struct sigaction ours = {}, before = {};
    ours.sa_sigaction = on_step;
    ours.sa_flags = SA_SIGINFO;
    sigaction(SIGTRAP, &ours, &before);
    steps = 0;
    last_place = 0;
    __builtin_ia32_writeeflags_u64(__builtin_ia32_readeflags_u64() | kTrapFlag);
    work();
    __builtin_ia32_writeeflags_u64(__builtin_ia32_readeflags_u64() & ~kTrapFlag);
    sigaction(SIGTRAP, &before, nullptr);
    return steps;
}
#else
uint64_t count_steps(const std::function<void()>&)
{
    return 0;
}
#endif

} // namespace burnish
