// Errors from files and user input: a function returns a value or an Error, and throws no exception across modules.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace burnish {

// Exit codes of every burnish command.
enum class ExitCode : int {
    ok = 0,
    differ = 1,         // images or results differ
    usage = 2,          // wrong option or configuration
    size_mismatch = 3,  // images differ in size or channels
    bad_input = 4,      // unreadable, corrupt or refused input; too little memory or too few threads
    golden_missing = 5, // a reference is missing
    not_finite = 6,     // NaN or Inf in the picture
    output_failed = 7,  // an output could not be written (disk full, no permission)
    internal = 70,      // a fault in the program itself (EX_SOFTWARE of sysexits.h)
    unavailable = 77,   // the backend is absent: skipped
    stopped = 130,      // stopped by the caller or by Ctrl-C
};

struct Error {
    ExitCode code = ExitCode::bad_input;
    std::string file;       // path as the user gave it, or empty
    std::string place;      // JSON path ("/meshes/0/primitives/1") or "byte 123", or empty
    std::string reason;     // one sentence without a line break
    std::string field = {}; // the setting that it is about, as C++ has it ("FrameDesc::brdf"), or empty; the program says its option

    std::string line() const // "file: place: field: reason", one line whatever the parts hold
    {
        std::string s;
        for (const std::string* part : {&file, &place, &field, &reason})
            if (!part->empty())
                s += (s.empty() ? "" : ": ") + *part;
        for (char& c : s)
            if (c == '\n' || c == '\r')
                c = ' ';
        return s;
    }
};

template <class T> class [[nodiscard]] Result {
  public:
    Result(T value) : state_(std::move(value)) {}
    Result(Error error) : state_(std::move(error)) {}
    explicit operator bool() const { return state_.index() == 0; }
    T& operator*() { return std::get<0>(state_); }
    const T& operator*() const { return std::get<0>(state_); }
    T* operator->() { return &std::get<0>(state_); }
    const T* operator->() const { return &std::get<0>(state_); }
    const Error& error() const { return std::get<1>(state_); }

  private:
    std::variant<T, Error> state_;
};

// Success, or an Error.
class [[nodiscard]] Status {
  public:
    Status() = default;
    Status(Error error) : error_(std::move(error)) {}
    explicit operator bool() const { return !error_; }
    const Error& error() const { return *error_; }

  private:
    std::optional<Error> error_;
};

} // namespace burnish

// Returns a failed Result's or Status's error from the enclosing function. Goes on after a success.
#define BN_TRY(...)                                                                                                                        \
    do {                                                                                                                                   \
        if (const auto& tried = (__VA_ARGS__); !tried)                                                                                     \
            return tried.error();                                                                                                          \
    } while (false)
