// libFuzzer entry: a small scene in memory, with any numbers, indices and sizes written over its own. Each step of 8 bytes: which number,
// its new value. A scene that passes the checks is drawn.
#include <cstring>
#include <vector>

#include "core/base/check.h"
#include "tests/unit/small_scene.h"

namespace {

using namespace burnish;

// Places in the scene that steps write to.
struct Places {
    std::vector<float*> floats;
    std::vector<std::int32_t*> ints;
    std::vector<std::uint32_t*> sizes;
    std::vector<std::uint8_t*> bytes;
    std::vector<bool*> flags;

    void add(float& v) { floats.push_back(&v); }
    template <int n> void add(glm::vec<n, float>& v)
    {
        for (int i = 0; i < n; ++i)
            floats.push_back(&v[i]);
    }
    void add(Column<float>& column)
    {
        for (float& v : column)
            floats.push_back(&v);
    }
    void add(TextureRef& ref)
    {
        ints.push_back(&ref.texture), bytes.push_back(&ref.uv_set);
        for (int c = 0; c < 3; ++c)
            add(ref.uv_transform[c]);
    }
    template <class Enum> void add_enum(Enum& v)
    {
        static_assert(sizeof(Enum) == 1);
        bytes.push_back(reinterpret_cast<std::uint8_t*>(&v));
    }
};

void add_surfaces(Scene& s, Places& p)
{
    for (Material& m : s.materials) {
#define BN_FACTOR(kind, name, fallback, path, least, most) p.add(m.name);
#define BN_FLAG(kind, name, path) p.flags.push_back(&m.name);
#define BN_CHOICE(type, name, words, path) p.add_enum(m.name);
#define BN_TEXTURE(name, path) p.add(m.name);
#include "core/scene/material.def"
        p.ints.push_back(&m.emitter), p.flags.push_back(&m.has_height_map);
    }
    for (Texture& t : s.textures) {
        p.ints.push_back(&t.image), p.flags.push_back(&t.nearest);
        p.add_enum(t.wrap_s), p.add_enum(t.wrap_t);
    }
    for (Image& i : s.images) {
        p.ints.insert(p.ints.end(), {&i.width, &i.height, &i.channels});
        p.add_enum(i.type);
    }
}

void add_lights(Scene& s, Places& p)
{
    for (Light& l : s.lights) {
#define BN_LIGHT_FACTOR(kind, name, fallback, path, least, most) p.add(l.name);
#include "core/scene/light.def"
    }
    for (AreaLight& l : s.area_lights) {
#define BN_AREA_FACTOR(kind, name, path, least, most) p.add(l.name);
#include "core/scene/area_light.def"
        for (glm::vec3& point : l.points)
            p.add(point);
        p.ints.push_back(&l.texture), p.flags.insert(p.flags.end(), {&l.two_sided, &l.solid});
        p.add_enum(l.shape);
    }
    for (Camera& c : s.cameras)
        for (float* v : {&c.yfov, &c.znear, &c.zfar, &c.xmag, &c.ymag})
            p.floats.push_back(v);
}

Places places_of(Scene& s)
{
    Places p;
    VertexTable& v = s.vertices;
    for (Column<float>* c :
         {&v.px, &v.py, &v.pz, &v.nx, &v.ny, &v.nz, &v.tx, &v.ty, &v.tz, &v.tw, &v.u0, &v.v0, &v.u1, &v.v1, &v.cr, &v.cg, &v.cb, &v.ca})
        p.add(*c);
    for (std::uint32_t& index : s.indices)
        p.sizes.push_back(&index);
    for (Primitive& t : s.primitives) {
        p.sizes.insert(p.sizes.end(), {&t.first_index, &t.index_count, &t.first_vertex, &t.vertex_count});
        p.ints.push_back(&t.material), p.flags.insert(p.flags.end(), {&t.has_uv0, &t.has_uv1, &t.has_color});
    }
    for (Mesh& m : s.meshes)
        p.sizes.insert(p.sizes.end(), {&m.first_primitive, &m.primitive_count});
    for (Node& n : s.nodes) {
        p.ints.insert(p.ints.end(), {&n.parent, &n.mesh, &n.camera, &n.light, &n.area_light});
        for (int c = 0; c < 4; ++c)
            p.add(n.local[c]);
    }
    add_surfaces(s, p), add_lights(s, p);
    return p;
}

// Changes the length of a table.
void resize(Scene& s, std::uint8_t which, std::uint8_t count)
{
    const std::size_t n = count % 9;
    VertexTable& v = s.vertices;
    Column<float>* const columns[] = {&v.px, &v.py, &v.pz, &v.nx, &v.ny, &v.nz, &v.tx, &v.ty, &v.tz,
                                      &v.tw, &v.u0, &v.v0, &v.u1, &v.v1, &v.cr, &v.cg, &v.cb, &v.ca};
    switch (which % 29) {
    case 18:
        s.indices.resize(n);
        break;
    case 19:
        s.primitives.resize(n);
        break;
    case 20:
        s.meshes.resize(n);
        break;
    case 21:
        s.nodes.resize(n);
        break;
    case 22:
        s.materials.resize(n);
        break;
    case 23:
        s.textures.resize(n);
        break;
    case 24:
        s.images.resize(n);
        break;
    case 25:
        s.lights.resize(n);
        break;
    case 26:
        s.area_lights.resize(n);
        break;
    case 27:
        s.cameras.resize(n);
        break;
    case 28:
        for (Image& i : s.images)
            i.bytes.resize(n);
        break;
    default:
        columns[which % 29]->resize(n);
        break;
    }
}

template <class T> void write_to(const std::vector<T*>& places, std::uint16_t at, std::uint32_t bits)
{
    if (!places.empty())
        std::memcpy(static_cast<void*>(places[at % places.size()]), &bits, sizeof(T));
}

void change(Scene& s, const std::uint8_t* step)
{
    std::uint16_t at = 0;
    std::uint32_t bits = 0;
    std::memcpy(&at, step + 2, sizeof at), std::memcpy(&bits, step + 4, sizeof bits);
    const Places p = places_of(s);
    switch (step[0] % 8) {
    case 0:
        return write_to(p.ints, at, bits);
    case 1:
        return write_to(p.sizes, at, bits);
    case 2:
        return write_to(p.bytes, at, bits);
    case 3:
        if (!p.flags.empty())
            *p.flags[at % p.flags.size()] = bits & 1;
        return;
    case 4:
        return resize(s, step[2], step[3]);
    default:
        return write_to(p.floats, at, bits);
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    constexpr std::size_t kStep = 8, kMostSteps = 16;
    Scene scene = test::good_scene();
    for (std::size_t at = 0; at + kStep <= size && at < kMostSteps * kStep; at += kStep)
        change(scene, data + at);
    Limits limits;
    limits.image_side = 64, limits.texture_bytes = 1u << 16;
    const Result<std::shared_ptr<const SceneData>> made = make_scene_data("fuzz", std::move(scene), limits);
    if (!made) {
        BN_CHECK(!made.error().reason.empty() && made.error().code == ExitCode::bad_input);
        return 0;
    }
    static const auto jobs = std::make_shared<const Jobs>(1);
    static const auto dfg = *standard_dfg(*jobs);
    Result<Session> session = Session::make({*made, test::small_environment(), jobs, dfg});
    if (!session) {
        BN_CHECK(!session.error().reason.empty() && session.error().code != ExitCode::internal);
        return 0;
    }
    FrameDesc desc;
    desc.width = 17, desc.height = 11, desc.msaa = size & 1 ? 4 : 1;
    desc.technique = size & 2 ? "bent_normal" : "lobe_line", desc.samples = 4;
    desc.view = session->framed(desc.width, desc.height);
    const Result<Frame> frame = session->render(desc);
    BN_CHECK(!session->tables().draws.empty());
    if (!frame)
        BN_CHECK(!frame.error().reason.empty() && frame.error().code != ExitCode::internal);
    else
        BN_CHECK_OP(frame->color.bytes.size(), ==, 17u * 11u * 3u * sizeof(float));
    // Move a node
    if (size < kStep)
        return 0;
    SceneChanges changes;
    changes.nodes.emplace_back(data[0] % static_cast<int>(session->scene().nodes.size()), glm::mat4(1.0f));
    std::memcpy(static_cast<void*>(&changes.nodes[0].second[data[1] % 4]), data + 4, sizeof(float));
    const Status changed = session->change(std::move(changes));
    BN_CHECK(changed || changed.error().code == ExitCode::bad_input || changed.error().code == ExitCode::usage);
    const Result<Frame> again = session->render(desc);
    BN_CHECK(again || again.error().code != ExitCode::internal);
    return 0;
}
