// Column<T>: a table column, 64-byte aligned and padded. Reads up to kColumnPad elements past the end are legal and
// return zeros. Holds plain data only.
#pragma once
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

namespace burnish {

inline constexpr std::size_t kColumnAlign = 64;
inline constexpr std::size_t kColumnPad = 16; // elements readable past the end: one AVX-512 register of 32-bit lanes

template <class T> class Column {
    static_assert(std::is_trivially_copyable_v<T>);

  public:
    Column() = default;
    explicit Column(std::size_t n) { resize(n); }
    Column(const Column& other) { assign(other.data_, other.size_); }
    Column(Column&& other) noexcept { swap(other); }
    Column& operator=(Column other) noexcept
    {
        swap(other);
        return *this;
    }
    ~Column() { std::free(data_); }

    void assign(const T* from, std::size_t n)
    {
        resize(n);
        if (n)
            std::memcpy(static_cast<void*>(data_), from, n * sizeof(T));
    }
    // Changes the size. New elements are zero. Shrinking keeps the memory.
    void resize(std::size_t n)
    {
        reserve(n);
        const std::size_t from = n < size_ ? n : size_;
        if (data_)
            std::memset(static_cast<void*>(data_ + from), 0, (n + kColumnPad - from) * sizeof(T));
        size_ = n;
    }
    // Changes the size. New elements are undefined until they are written.
    void resize_for_overwrite(std::size_t n)
    {
        reserve(n);
        if (data_)
            std::memset(static_cast<void*>(data_ + n), 0, kColumnPad * sizeof(T));
        size_ = n;
    }
    // Leaves memory past the pad untouched: large columns own no pages there.
    void reserve(std::size_t n)
    {
        if (n <= capacity_ && data_)
            return;
        std::size_t want = capacity_ + capacity_ / 2 > n ? capacity_ + capacity_ / 2 : n;
        std::size_t bytes = (want + kColumnPad) * sizeof(T);
        bytes = (bytes + kColumnAlign - 1) / kColumnAlign * kColumnAlign;
        T* grown = static_cast<T*>(std::aligned_alloc(kColumnAlign, bytes));
        if (!grown)
            throw std::bad_alloc();
        if (size_)
            std::memcpy(static_cast<void*>(grown), data_, size_ * sizeof(T));
        std::memset(static_cast<void*>(grown + size_), 0, kColumnPad * sizeof(T));
        std::free(data_);
        data_ = grown;
        capacity_ = want;
    }
    void push_back(const T& value)
    {
        const T copy = value;
        if (size_ == capacity_ || !data_)
            reserve(size_ + 1);
        std::memset(static_cast<void*>(data_ + size_ + kColumnPad), 0, sizeof(T));
        data_[size_++] = copy;
    }
    void clear() { resize(0); }
    void swap(Column& other) noexcept
    {
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
        std::swap(capacity_, other.capacity_);
    }

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    T* data() { return data_; }
    const T* data() const { return data_; }
    T& operator[](std::size_t i) { return data_[i]; }
    const T& operator[](std::size_t i) const { return data_[i]; }
    T* begin() { return data_; }
    T* end() { return data_ + size_; }
    const T* begin() const { return data_; }
    const T* end() const { return data_ + size_; }
    std::span<const T> span() const { return {data_, size_}; }

  private:
    T* data_ = nullptr;
    std::size_t size_ = 0;
    std::size_t capacity_ = 0;
};

} // namespace burnish
