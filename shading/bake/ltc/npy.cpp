#include "shading/bake/ltc/npy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <string_view>
#include <vector>

#include "shading/bake/ltc/shipped.h"

namespace burnish::ltc {
namespace {

constexpr std::string_view kNpyMagic = "\x93NUMPY";

struct NpyHeader {
    std::size_t data = 0; // byte where the numbers begin
    bool doubles = false;
    std::vector<std::size_t> shape;
};

// Returns the text behind a key of the header's dictionary, or nothing.
std::string_view text_of(std::string_view header, std::string_view key)
{
    const std::size_t at = header.find(fmt::format("'{}'", key));
    const std::size_t colon = at == header.npos ? at : header.find(':', at);
    if (colon == header.npos)
        return {};
    const std::size_t first = header.find_first_not_of(' ', colon + 1);
    return first == header.npos ? std::string_view() : header.substr(first);
}

// Reads "(8, 8, 3)": numbers of at most three digits. Returns nothing for other texts.
std::vector<std::size_t> shape_of(std::string_view text)
{
    constexpr std::size_t kMostNumbers = 8, kMostNumber = 999;
    std::vector<std::size_t> shape;
    bool open = false; // a number goes on
    for (std::size_t i = 1; i < text.size() && text.front() == '('; ++i) {
        const char c = text[i];
        if (c == ')')
            return shape;
        if (c >= '0' && c <= '9') {
            if (!open)
                shape.push_back(0);
            shape.back() = 10 * shape.back() + static_cast<std::size_t>(c - '0');
            if (shape.size() > kMostNumbers || shape.back() > kMostNumber)
                return {};
        } else if (c != ',' && c != ' ') {
            return {};
        }
        open = c >= '0' && c <= '9';
    }
    return {};
}

Result<NpyHeader> header_of(const std::uint8_t* data, std::size_t bytes, const std::string& path)
{
    const auto refuse = [&](const std::string& place, const std::string& reason) {
        return Error{ExitCode::bad_input, path, place, reason};
    };
    constexpr std::size_t kAhead = 12; // magic, version, length of the header
    if (bytes < kAhead)
        return refuse(fmt::format("byte {}", bytes), "ends within the header");
    if (data[6] < 1 || data[6] > 3)
        return refuse("byte 6", fmt::format("has version {} of NumPy's format; versions 1 to 3 are read", data[6]));
    const bool wide = data[6] >= 2;
    const std::size_t first = wide ? 12 : 10;
    std::size_t length = data[8] | std::size_t{data[9]} << 8;
    if (wide)
        length |= std::size_t{data[10]} << 16 | std::size_t{data[11]} << 24;
    if (length > bytes - first)
        return refuse("byte 8", "has a header beyond its end");
    const std::string_view header(reinterpret_cast<const char*>(data) + first, length);
    NpyHeader out;
    out.data = first + length;
    const std::string_view type = text_of(header, "descr");
    out.doubles = type.substr(0, 5) == "'<f8'";
    if (!out.doubles && type.substr(0, 5) != "'<f4'")
        return refuse("descr", "is no array of little-endian floats or doubles");
    if (text_of(header, "fortran_order").substr(0, 5) != "False")
        return refuse("fortran_order", "must be False");
    out.shape = shape_of(text_of(header, "shape"));
    return out;
}

// Returns the matrix as a table stores it: the third column unit, rounded to floats.
Matrix stored_form(const Matrix& m)
{
    Matrix r = with_unit_axis(m);
    for (double& element : r)
        element = static_cast<double>(static_cast<float>(element));
    return r;
}

} // namespace

bool is_npy(const std::uint8_t* data, std::size_t bytes)
{
    return bytes >= kNpyMagic.size() && std::memcmp(data, kNpyMagic.data(), kNpyMagic.size()) == 0;
}

Result<Table> parse_npy(const std::uint8_t* data, std::size_t bytes, const std::string& path, int size)
{
    const auto refuse = [&](const std::string& place, const std::string& reason) {
        return Error{ExitCode::bad_input, path, place, reason};
    };
    const Result<NpyHeader> header = header_of(data, bytes, path);
    BN_TRY(header);
    // Check the shape
    const std::vector<std::size_t>& shape = header->shape;
    const std::size_t n = shape.empty() ? 0 : shape.front();
    if (shape != std::vector<std::size_t>{n, n, n, n, 3, 3} || n < kLeastSize || n > kMostSize)
        return refuse("shape", fmt::format("is not n x n x n x n x 3 x 3 with n from {} to {}", kLeastSize, kMostSize));
    if (size != 0 && n != static_cast<std::size_t>(size))
        return refuse("shape", fmt::format("has {} nodes along an axis, {} are asked for", n, size));
    Grid grid;
    grid.size = static_cast<int>(n), grid.beyond = 0;
    grid.root_alpha = grid.over_alpha = false, grid.basis = Basis::tangent;
    const std::size_t width = header->doubles ? sizeof(double) : sizeof(float), whole = header->data + grid.nodes() * 9 * width;
    if (bytes != whole)
        return refuse(fmt::format("byte {}", std::min(bytes, whole)), fmt::format("has {} bytes, which must be {}", bytes, whole));
    // Read the matrices
    const auto number = [&](std::size_t i) {
        const std::uint8_t* const at = data + header->data + i * width;
        float single = 0.0f;
        double both = 0.0;
        std::memcpy(header->doubles ? static_cast<void*>(&both) : &single, at, width);
        return header->doubles ? both : static_cast<double>(single);
    };
    std::vector<Matrix> entries(grid.nodes());
    std::vector<Albedo> albedos(grid.nodes());
    double lean = 0.0; // of lobes along x, where the eye leans to +x
    for (std::size_t node = 0; node < entries.size(); ++node) {
        const std::array<int, 4> at = grid.indices(node);
        const auto axis = [&](int k) { return static_cast<std::size_t>(at[static_cast<std::size_t>(k)]); };
        const std::size_t stored = ((axis(2) * n + axis(3)) * n + axis(0)) * n + axis(1);
        Matrix m;
        for (std::size_t e = 0; e < 9; ++e)
            m[e] = number(9 * stored + e);
        const std::string place = fmt::format("[alpha {}][lambda {}][theta {}][phi {}]", at[2], at[3], at[0], at[1]);
        const double axis2 = m[2] * m[2] + m[5] * m[5] + m[8] * m[8];
        if (!(axis2 > 0.0))
            return refuse(place, "has a third column without length");
        for (const double element : m)
            if (!(std::abs(element) < 1e6 * std::sqrt(axis2)))
                return refuse(place, "holds an element that is no number, or too large for the third column");
        if (determinant(m) < 0.0)
            m[1] = -m[1], m[4] = -m[4], m[7] = -m[7];
        const Place lobe = grid.place(node);
        entries[node] = stored_form(m);
        if (!(determinant(entries[node]) > 0.0))
            entries[node] = stored_form(natural_matrix(lobe));
        const Looked built_in = lookup(shipped_table(), lobe);
        albedos[node] = {built_in.all, built_in.grazing};
        if (at[1] == 0)
            lean += entries[node][2];
    }
    // Seen along the normal, a round lobe has equal columns
    for (int alpha = 1; alpha < grid.size; ++alpha) {
        const Matrix& round = entries[grid.node(0, 0, alpha, grid.size - 1)];
        if (!(std::abs(round[0] - round[4]) < 0.1 * std::abs(round[4])))
            return refuse(fmt::format("[alpha {}][lambda {}][theta 0][phi 0]", alpha, grid.size - 1),
                          "is no round lobe: matrices by both widths are not read, but by the greater width and the ratio");
    }
    if (lean > 0.0)
        return refuse("", "holds lobes that lean to the eye's side, not to the mirrored side");
    return make_table(grid, entries, albedos, kUnsymmetric);
}

} // namespace burnish::ltc
