// Parts of C++20 that the C++ library of emscripten 3.1 lacks. Included before each source.
#pragma once
#ifdef __cplusplus
#include <algorithm>
#include <atomic>
#include <bit>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <string>

#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 14000
namespace std {

template <class To, class From> constexpr To bit_cast(const From& from) noexcept
{
    return __builtin_bit_cast(To, from);
}

template <class T> class atomic_ref {
  public:
    explicit atomic_ref(T& value) : value_(&value) {}
    void store(T next, memory_order) const { __atomic_store_n(value_, next, __ATOMIC_SEQ_CST); }
    T fetch_add(T more, memory_order) const { return __atomic_fetch_add(value_, more, __ATOMIC_SEQ_CST); }
    T operator+=(T more) const { return __atomic_add_fetch(value_, more, __ATOMIC_SEQ_CST); }

  private:
    T* value_;
};

// Reads as long as the text is a decimal number, without a leading blank or plus sign.
template <class T> from_chars_result from_decimal_chars(const char* first, const char* last, T& value, T (*read)(const char*, char**))
{
    const auto digit = [](char c) { return c >= '0' && c <= '9'; };
    const char* at = first;
    const auto skip_digits = [&] {
        const char* const begin = at;
        while (at != last && digit(*at))
            ++at;
        return at - begin;
    };
    at += at != last && *at == '-';
    auto digits = skip_digits();
    if (at != last && *at == '.') {
        ++at;
        digits += skip_digits();
    }
    if (digits == 0)
        return {first, errc::invalid_argument};
    if (at != last && (*at == 'e' || *at == 'E')) {
        const char* const exponent = at;
        ++at;
        at += at != last && (*at == '-' || *at == '+');
        if (skip_digits() == 0)
            at = exponent;
    }
    const string text(first, at);
    const T number = read(text.c_str(), nullptr);
    const bool zero = text.find_first_of("123456789") >= min(text.size(), text.find_first_of("eE"));
    if (number - number != T{} || (number == T{} && !zero))
        return {at, errc::result_out_of_range};
    value = number;
    return {at, errc()};
}
inline from_chars_result from_chars(const char* first, const char* last, double& value)
{
    return from_decimal_chars<double>(first, last, value, strtod);
}
inline from_chars_result from_chars(const char* first, const char* last, float& value)
{
    return from_decimal_chars<float>(first, last, value, strtof);
}

// Writes the fewest digits that give the same number back.
inline to_chars_result to_chars(char* first, char* last, float value)
{
    constexpr int kMostDigits = 9;
    int length = 0;
    for (int digits = 1; digits <= kMostDigits; ++digits) {
        length = snprintf(first, static_cast<size_t>(last - first), "%.*g", digits, static_cast<double>(value));
        if (strtof(first, nullptr) == value)
            break;
    }
    return {first + length, errc()};
}

} // namespace std
#endif
#endif
