// The words of Metal that exported shaders use, so that a C++ compiler takes them.
#pragma once
#include <cmath>
#include <cstring>
#include <glm/glm.hpp>

using uint = unsigned;
using float2 = glm::vec2;
using float3 = glm::vec3;
using float4 = glm::vec4;
using glm::cross, glm::dot;
using std::abs, std::floor, std::rint, std::sqrt;

template <class To, class From> To as_type(From from)
{
    static_assert(sizeof(To) == sizeof(From));
    To to;
    std::memcpy(&to, &from, sizeof(to));
    return to;
}

#define kernel
#define device
#define thread
#define constant static const
