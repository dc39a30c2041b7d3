// Trace: each thread appends to its own list of chunks, so a span takes no lock. Readers see only complete events,
// because a chunk publishes its count after the counted event.
#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <vector>

#include <fmt/format.h>

#include "core/jobs/jobs.h"

namespace burnish {
namespace {

constexpr std::size_t kMaxEvents = 1'000'000;
constexpr std::size_t kChunkEvents = 1024;

struct Event {
    const char* name;
    std::uint64_t begin_ns, end_ns;
};

struct Chunk {
    std::array<Event, kChunkEvents> events;
    std::atomic<std::size_t> count{0};
    std::atomic<Chunk*> next{nullptr};
};

struct ThreadEvents {
    Chunk first;
    Chunk* last = &first; // touched only by the owning thread

    ~ThreadEvents()
    {
        for (Chunk* chunk = first.next.load(); chunk;) {
            Chunk* next = chunk->next.load();
            delete chunk;
            chunk = next;
        }
    }
    void append(const Event& event)
    {
        std::size_t n = last->count.load(std::memory_order_relaxed);
        if (n == kChunkEvents) {
            Chunk* grown = new Chunk;
            last->next.store(grown, std::memory_order_release);
            last = grown;
            n = 0;
        }
        last->events[n] = event;
        last->count.store(n + 1, std::memory_order_release);
    }
};

struct State {
    std::atomic<bool> on{false};
    std::atomic<std::uint64_t> start_ns{0};
    std::atomic<std::size_t> spans{0};                  // including spans dropped above the cap
    std::mutex mutex;                                   // guards `threads`
    std::vector<std::unique_ptr<ThreadEvents>> threads; // index = tid; kept after the thread ends
};

// Leaked on purpose: pool threads may still run while static objects are destroyed.
State& state()
{
    static State* const s = new State;
    return *s;
}

ThreadEvents& own_events()
{
    thread_local ThreadEvents* events = nullptr;
    if (!events) {
        State& s = state();
        const std::lock_guard lock(s.mutex);
        s.threads.push_back(std::make_unique<ThreadEvents>());
        events = s.threads.back().get();
    }
    return *events;
}

std::string escaped(const char* text)
{
    std::string out;
    for (; *text; ++text) {
        const unsigned char c = static_cast<unsigned char>(*text);
        if (c == '"' || c == '\\') {
            out += '\\';
            out += *text;
        } else if (c < 0x20) {
            out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        } else {
            out += *text;
        }
    }
    return out;
}

// Formats nanoseconds as microseconds with three decimals.
std::string micros(std::uint64_t ns)
{
    return fmt::format("{}.{:03}", ns / 1000, ns % 1000);
}

void append_thread(std::string& out, const ThreadEvents& thread, std::size_t tid, std::uint64_t start_ns)
{
    out += fmt::format("{}{{\"name\":\"thread_name\",\"ph\":\"M\",\"pid\":1,\"tid\":{},\"args\":{{\"name\":\"{}\"}}}}",
                       tid == 0 ? "" : ",\n", tid, tid == 0 ? std::string("main") : fmt::format("worker {}", tid));
    for (const Chunk* chunk = &thread.first; chunk; chunk = chunk->next.load(std::memory_order_acquire)) {
        const std::size_t n = chunk->count.load(std::memory_order_acquire);
        for (std::size_t i = 0; i < n; ++i) {
            const Event& e = chunk->events[i];
            const std::uint64_t ts = e.begin_ns > start_ns ? e.begin_ns - start_ns : 0;
            const std::uint64_t duration = e.end_ns > e.begin_ns ? e.end_ns - e.begin_ns : 0;
            out += fmt::format(",\n{{\"name\":\"{}\",\"ph\":\"X\",\"pid\":1,\"tid\":{},\"ts\":{},\"dur\":{}}}", escaped(e.name), tid,
                               micros(ts), micros(duration));
        }
    }
}

} // namespace

void Trace::start()
{
    State& s = state();
    if (s.on.load())
        return;
    own_events(); // the thread that starts the trace is tid 0, "main"
    s.start_ns.store(now_ns());
    s.on.store(true, std::memory_order_release);
}

bool Trace::on()
{
    return state().on.load(std::memory_order_relaxed);
}

std::uint64_t Trace::now_ns()
{
    const auto since_epoch = std::chrono::steady_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(since_epoch).count());
}

void Trace::span(const char* name, std::uint64_t begin_ns, std::uint64_t end_ns)
{
    State& s = state();
    if (!s.on.load(std::memory_order_relaxed))
        return;
    if (s.spans.fetch_add(1, std::memory_order_relaxed) < kMaxEvents)
        own_events().append({name, begin_ns, end_ns});
}

std::string Trace::json()
{
    State& s = state();
    const std::lock_guard lock(s.mutex);
    const std::size_t spans = s.spans.load();
    std::string out = "{\"displayTimeUnit\":\"ms\",\"traceEvents\":[\n";
    for (std::size_t tid = 0; tid < s.threads.size(); ++tid)
        append_thread(out, *s.threads[tid], tid, s.start_ns.load());
    out += fmt::format("\n],\"otherData\":{{\"dropped_events\":{}}}}}\n", spans > kMaxEvents ? spans - kMaxEvents : 0);
    return out;
}

} // namespace burnish
