#include "raster/frame/frame.h"
