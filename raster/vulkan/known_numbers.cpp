#include "raster/vulkan/known_numbers.h"

namespace burnish::spirv {

Buffers::Buffers(const std::vector<Instruction>& globals, const std::vector<KnownNumber>& numbers)
{
    for (const KnownNumber& n : numbers)
        numbers_[{n.binding, n.offset}] = n.value;
    for (const Instruction& i : globals) {
        if (i.op() == kTypeInt || i.op() == kTypeArray || i.op() == kTypeRuntimeArray || i.op() == kTypeStruct)
            types_[i.words[1]] = i;
        else if (i.op() == kTypePointer)
            pointees_[i.words[1]] = i.words[3];
        else if (i.op() == kMemberDecorate && i.count() == 5 && i.words[3] == kOffsetDecoration)
            offsets_[{i.words[1], i.words[2]}] = i.words[4];
        else if (i.op() == kDecorate && i.count() == 4 && i.words[2] == kBindingDecoration)
            bindings_[i.words[1]] = i.words[3];
        else if (i.op() == kDecorate && i.count() == 4 && i.words[2] == kStrideDecoration)
            strides_[i.words[1]] = i.words[3];
        else if (i.op() == kDecorate && i.count() == 4 && i.words[2] == kSetDecoration && i.words[3] != 0)
            elsewhere_.insert(i.words[1]);
        else if (i.op() == kVariable)
            variables_[i.words[2]] = i.words[1];
    }
}

std::optional<std::int32_t> Buffers::number_at(const Instruction& chain, const Values& values) const
{
    const auto variable = variables_.find(chain.words[3]);
    const auto binding = bindings_.find(chain.words[3]);
    if (numbers_.empty() || variable == variables_.end() || binding == bindings_.end() || elsewhere_.count(chain.words[3]))
        return std::nullopt;
    const auto pointee = pointees_.find(variable->second);
    std::uint32_t type = pointee == pointees_.end() ? 0 : pointee->second, offset = 0;
    for (std::uint32_t w = 4; w < chain.count(); ++w) {
        const auto known = types_.find(type);
        if (known == types_.end())
            return std::nullopt;
        if (known->second.op() == kTypeRuntimeArray) {
            type = known->second.words[2], offset = 0;
            continue;
        }
        const auto member = value_in(values, chain.words[w]);
        const auto stride = strides_.find(type);
        if (known->second.op() == kTypeArray && stride != strides_.end() && member && *member >= 0) {
            type = known->second.words[2], offset += static_cast<std::uint32_t>(*member) * stride->second;
            continue;
        }
        if (known->second.op() != kTypeStruct || !member || *member < 0 || static_cast<std::uint32_t>(*member) + 2 >= known->second.count())
            return std::nullopt;
        const auto place = offsets_.find({type, static_cast<std::uint32_t>(*member)});
        if (place == offsets_.end())
            return std::nullopt;
        offset += place->second;
        type = known->second.words[static_cast<std::uint32_t>(*member) + 2];
    }
    const auto loaded = types_.find(type);
    const auto number = numbers_.find({binding->second, offset});
    return loaded != types_.end() && loaded->second.op() == kTypeInt && number != numbers_.end() ? std::optional(number->second)
                                                                                                 : std::nullopt;
}

} // namespace burnish::spirv
