#include "raster/vulkan/frame_numbers.h"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "shading/lang/tables.h"

namespace burnish {
namespace {

struct IntegerField {
    std::uint32_t offset;
    int MaterialRecord::*of;
    bool differs; // between frames that share pipelines: by technique, lobe or tilt
};
#define BN_MATERIAL_INTEGER(name, differs)                                                                                                 \
    {                                                                                                                                      \
        offsetof(MaterialRecord, name), &MaterialRecord::name, differs                                                                     \
    }
constexpr IntegerField kMaterialIntegers[] = {
    BN_MATERIAL_INTEGER(unlit, false),       BN_MATERIAL_INTEGER(alpha_mode, false),  BN_MATERIAL_INTEGER(textured, false),
    BN_MATERIAL_INTEGER(uses_color, false),  BN_MATERIAL_INTEGER(anisotropic, false), BN_MATERIAL_INTEGER(tilted, true),
    BN_MATERIAL_INTEGER(tilt_mapped, false), BN_MATERIAL_INTEGER(moments, false),     BN_MATERIAL_INTEGER(coat_spread, false),
    BN_MATERIAL_INTEGER(parallax, false),    BN_MATERIAL_INTEGER(conductor, false),   BN_MATERIAL_INTEGER(roughness_fixed, false),
    BN_MATERIAL_INTEGER(refracts, false),    BN_MATERIAL_INTEGER(film, false),        BN_MATERIAL_INTEGER(thin, false),
    BN_MATERIAL_INTEGER(coatings, false),    BN_MATERIAL_INTEGER(frame_map, false),   BN_MATERIAL_INTEGER(keeps, false),
    BN_MATERIAL_INTEGER(facets, false),      BN_MATERIAL_INTEGER(technique, true),    BN_MATERIAL_INTEGER(technique_traits, true),
    BN_MATERIAL_INTEGER(lights_lobe, true),
};
#undef BN_MATERIAL_INTEGER

void add_frame_numbers(const FrameRecord& frame, const std::vector<FrameDesc>& others, std::vector<KnownNumber>& to)
{
    const auto add = [&](std::size_t offset, int value) { to.push_back({kFrameBinding, static_cast<std::uint32_t>(offset), value}); };
    const auto add_zero = [&](std::size_t offset, int value) {
        if (value == 0)
            add(offset, 0);
    };
    add_zero(offsetof(FrameRecord, light_count), frame.light_count);
    add_zero(offsetof(FrameRecord, area_light_count), frame.area_light_count);
    add_zero(offsetof(FrameRecord, extracted_light_count), frame.extracted_light_count);
    add(offsetof(FrameRecord, positions), frame.positions);
    add(offsetof(FrameRecord, background), frame.background);
    add(offsetof(FrameRecord, override_anisotropy), frame.override_anisotropy);
    if (others.empty())
        add(offsetof(FrameRecord, lobe), frame.lobe), add(offsetof(FrameRecord, lobe_traits), frame.lobe_traits);
    // Add parameters with few values, unless other frames have others
    const auto add_common = [&](std::size_t offset, int value, auto FrameDesc::*of) {
        if (std::all_of(others.begin(), others.end(), [&](const FrameDesc& o) { return static_cast<int>(o.*of) == value; }))
            add(offset, value);
    };
#define BN_KNOWN_number(id)
#define BN_KNOWN_whole(id)
#define BN_KNOWN_angles(id)
#define BN_KNOWN_flag(id) add_common(offsetof(FrameRecord, id), frame.id, &FrameDesc::id);
#define BN_KNOWN_choice(id) add_common(offsetof(FrameRecord, id), frame.id, &FrameDesc::id);
#define BN_KNOWN_lobe(id) add_common(offsetof(FrameRecord, id), frame.id, &FrameDesc::id);
#define BN_KNOWN_way(id) add_common(offsetof(FrameRecord, id), frame.id, &FrameDesc::id);
#define BN_PARAMETER(id, kind, option, fallback, least, most, unit, summary, readers) BN_KNOWN_##kind(id)
#include "shading/models.def"
}

// Returns the number that all records have, if there are records.
template <class Record> std::optional<int> common(const std::vector<Record>& records, int Record::*of)
{
    if (records.empty() || !std::all_of(records.begin(), records.end(), [&](const Record& r) { return r.*of == records.front().*of; }))
        return std::nullopt;
    return records.front().*of;
}

// Adds -1 where all materials have it; other values are places in tables, which differ by frame.
void add_absent(const std::vector<MaterialRecord>& materials, std::size_t offset, int MaterialRecord::*of, std::vector<KnownNumber>& to)
{
    if (common(materials, of) == -1)
        to.push_back({kMaterialsBinding, static_cast<std::uint32_t>(offset), -1});
}

} // namespace

Used used_by(const std::vector<FrameDesc>& frames, bool sharing)
{
    const auto& all = techniques();
    Used used;
    for (const FrameDesc& frame : frames) {
        for (std::size_t at = 0; at < all.size(); ++at)
            if (((all[at].traits & kSharesSamples) != 0) == sharing && frame.technique == all[at].name)
                used.techniques |= 1 << at;
        used.lobes |= 1 << lobe_with(kRoundLobe) | 1 << lobe_of(frame, frame.tilt_rad != glm::vec2(0.0f));
        if (frame.masking != 0)
            used.lobes |= 1 << lobe_with(kDefaultLobe) | 1 << lobe_with(kSeparableLobe);
    }
    return used;
}

Specialization technique_constants(const std::vector<MaterialRecord>& materials, const FrameRecord& frame, const Used& others)
{
    std::int32_t techniques = others.techniques, lobes = others.lobes | 1 << frame.lobe;
    if (frame.masking != 0) // the frame compares it with the default lobe
        lobes |= 1 << lobe_with(kDefaultLobe) | 1 << lobe_with(kSeparableLobe);
    static_assert(kLobeCount <= kGpuFirstAreaWay && kGpuFirstAreaWay + kAreaWays <= kGpuTransmits &&
                  kGpuFirstCoating + kCoatings <= kGpuFilms);
    if (frame.area_light_count > 0)
        lobes |= 1 << (kGpuFirstAreaWay + frame.area_way);
    for (const MaterialRecord& m : materials) {
        techniques |= 1 << m.technique, lobes |= 1 << m.lights_lobe;
        lobes |= m.refracts ? 1 << kGpuTransmits : 0;
        lobes |= m.film ? 1 << kGpuFilms : 0;
        // Add its coatings and their lobes
#define BN_COATING(id, at, strength, lobe)                                                                                                 \
    if (m.coatings >> at & 1)                                                                                                              \
        lobes |= 1 << (kGpuFirstCoating + at) | 1 << kLobe_##lobe;
#include "shading/coatings.def"
    }
    return {techniques, lobes};
}

std::vector<KnownNumber> known_numbers(const FrameRecord& frame, const std::vector<MaterialRecord>& materials,
                                       const std::vector<AreaLightRecord>& area_lights, const std::vector<FrameDesc>& others)
{
    std::vector<KnownNumber> numbers;
    add_frame_numbers(frame, others, numbers);
    for (const IntegerField& field : kMaterialIntegers)
        if (const std::optional<int> value = common(materials, field.of); value && !(field.differs && !others.empty()))
            numbers.push_back({kMaterialsBinding, field.offset, *value});
    add_absent(materials, offsetof(MaterialRecord, albedo_slice), &MaterialRecord::albedo_slice, numbers);
    add_absent(materials, offsetof(MaterialRecord, phong_slice), &MaterialRecord::phong_slice, numbers);
    add_absent(materials, offsetof(MaterialRecord, phong_set), &MaterialRecord::phong_set, numbers);
    // Add the area lights' shape, and the pictures that none of them has
    if (const std::optional<int> shape = common(area_lights, &AreaLightRecord::shape))
        numbers.push_back({kAreaLightsBinding, offsetof(AreaLightRecord, shape), *shape});
    if (std::all_of(area_lights.begin(), area_lights.end(), [](const AreaLightRecord& light) { return light.picture < 0; }))
        numbers.push_back({kAreaLightsBinding, offsetof(AreaLightRecord, picture), -1});
    // Add textures that no material has
    for (std::size_t slot = 0; slot < static_cast<std::size_t>(kTextureSlots); ++slot) {
        const auto without = [&](const MaterialRecord& m) { return m.textures[slot].texture < 0; };
        const std::size_t offset = offsetof(MaterialRecord, textures) + slot * sizeof(TextureBinding) + offsetof(TextureBinding, texture);
        if (std::all_of(materials.begin(), materials.end(), without))
            numbers.push_back({kMaterialsBinding, static_cast<std::uint32_t>(offset), -1});
    }
    return numbers;
}

} // namespace burnish
