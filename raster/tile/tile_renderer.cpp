#include "raster/tile/tile_renderer.h"
