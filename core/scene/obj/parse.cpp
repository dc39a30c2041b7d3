#include "core/scene/obj/parse.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <sstream>
#include <tiny_obj_loader.h>

namespace burnish::obj {
namespace {

struct Reader {
    const std::string& path;
    Parsed parsed;
    std::string name;
    bool new_group = true;
    std::uint64_t polygons = 0;

    void refuse(const std::string& place, const std::string& reason)
    {
        if (!parsed.wrong)
            parsed.wrong = Error{ExitCode::bad_input, path, place, reason};
    }

    void number(std::vector<float>& to, float value, const char* what, std::size_t size)
    {
        if (!std::isfinite(value))
            refuse(fmt::format("{} {}", what, to.size() / size + 1), "is no number that a float holds");
        to.push_back(value);
    }

    // written: as in the file, from 1 or, backwards from what was read so far, from -1; 0: left out.
    std::int64_t index(int written, std::size_t count, const char* what)
    {
        const std::int64_t have = static_cast<std::int64_t>(count);
        const std::int64_t at = written > 0 ? written - 1 : have + written;
        if (at < 0 || at >= have)
            refuse(fmt::format("face {}", polygons), fmt::format("index {} of {} that came before it", written, what));
        return at;
    }

    void polygon(const tinyobj::index_t* indices, int count)
    {
        ++polygons;
        if (new_group)
            parsed.groups.push_back({name, {}, {}});
        new_group = false;
        Group& group = parsed.groups.back();
        if (count < 3)
            return refuse(fmt::format("face {}", polygons), "has fewer than three corners");
        for (int i = 0; i < count; ++i) {
            const tinyobj::index_t& of = indices[i];
            const std::int64_t position = index(of.vertex_index, parsed.positions.size() / 3, "positions");
            const std::int64_t uv = of.texcoord_index ? index(of.texcoord_index, parsed.uvs.size() / 2, "texture coordinates") : -1;
            const std::int64_t normal = of.normal_index ? index(of.normal_index, parsed.normals.size() / 3, "normals") : -1;
            group.corners.push_back({position, uv, normal});
        }
        group.counts.push_back(static_cast<std::uint32_t>(count));
    }

    void begin(const std::string& called)
    {
        name = called;
        new_group = true;
    }
};

// The library reads indices without a look at how long they are: the first face, from 1, of one that no int holds, 0: none.
std::uint64_t overlong_face(const std::string& text)
{
    std::uint64_t face = 0;
    for (std::size_t line = 0; line < text.size();
         line = text.find('\n', line) == std::string::npos ? text.size() : text.find('\n', line) + 1) {
        line = std::min(text.find_first_not_of(" \t", line), text.size());
        if (text.compare(line, 2, "f ") != 0 && text.compare(line, 2, "f\t") != 0)
            continue;
        ++face;
        std::size_t digits = 0;
        for (std::size_t i = line; i < text.size() && text[i] != '\n'; ++i) {
            digits = text[i] >= '0' && text[i] <= '9' ? digits + 1 : 0;
            if (digits > 9)
                return face;
        }
    }
    return 0;
}

Reader& of(void* user)
{
    return *static_cast<Reader*>(user);
}

} // namespace

Parsed parse(const std::string& path, const std::string& text)
{
    Reader reader{path, {}, {}};
    if (const std::uint64_t face = overlong_face(text)) {
        reader.refuse(fmt::format("face {}", face), "has an index of more than 9 digits");
        return std::move(reader.parsed);
    }
    tinyobj::callback_t on;
    on.vertex_cb = [](void* user, float x, float y, float z, float) {
        for (const float value : {x, y, z})
            of(user).number(of(user).parsed.positions, value, "position", 3);
    };
    on.normal_cb = [](void* user, float x, float y, float z) {
        for (const float value : {x, y, z})
            of(user).number(of(user).parsed.normals, value, "normal", 3);
    };
    on.texcoord_cb = [](void* user, float x, float y, float) {
        for (const float value : {x, y})
            of(user).number(of(user).parsed.uvs, value, "texture coordinate", 2);
    };
    on.index_cb = [](void* user, tinyobj::index_t* indices, int count) { of(user).polygon(indices, count); };
    on.usemtl_cb = [](void* user, const char*, int) { of(user).parsed.names_materials = true; };
    on.group_cb = [](void* user, const char** names, int count) { of(user).begin(count > 0 ? names[0] : ""); };
    on.object_cb = [](void* user, const char* name) { of(user).begin(name); };
    std::istringstream stream(text);
    std::string warning, wrong;
    if (!tinyobj::LoadObjWithCallback(stream, on, &reader, nullptr, &warning, &wrong))
        reader.refuse("", wrong.empty() ? "is no OBJ file" : wrong.substr(0, wrong.find('\n')));
    if (text.find("\nmtllib") != std::string::npos || text.rfind("mtllib", 0) == 0)
        reader.parsed.names_materials = true;
    return std::move(reader.parsed);
}

} // namespace burnish::obj
