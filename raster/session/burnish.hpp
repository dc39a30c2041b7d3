// All of the C++ library: sessions, scenes in memory, pictures and their comparison. Installed as <burnish/burnish.hpp>.
#pragma once
#include "core/image/io/image_io.h"
#include "core/image/metrics/flip.h"
#include "core/image/metrics/metrics.h"
#include "core/jobs/control.h"
#include "core/scene/add_mesh.h"
#include "core/scene/builtin/builtin.h"
#include "core/scene/gltf/gltf.h"
#include "raster/frame/choices.h"
#include "raster/frame/layers.h"
#include "raster/session/mirror.h"
#include "raster/session/session.h"
#include "raster/session/shadows.h"
