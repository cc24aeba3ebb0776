// Textures and skies from image files.
#pragma once

#include "tracer/io/image_decode.h"
#include "tracer/scene/environment.h"
#include "tracer/scene/texture.h"

#include <filesystem>
#include <memory>

namespace raypick {

// PNG, JPEG, TGA, BMP, HDR, EXR. Bytes of a file are taken as `coding` says; linear values of HDR
// and EXR are cut to 0..1. Throws FileError.
std::shared_ptr<const TexturePixels> read_texture(const std::filesystem::path& file,
                                                  TexelCoding coding);
// An image's bytes; those of HDR and EXR coded as said, cut to 0..1.
ByteImage as_bytes(DecodedImage image, TexelCoding coding);

// An equirectangular image: HDR and EXR as they are, the others as sRGB. Throws FileError.
std::shared_ptr<const SkyPixels> read_sky(const std::filesystem::path& file);

// What is shown in place of an image that can't be read: a checker of magenta and black.
std::shared_ptr<const TexturePixels> placeholder_texture();

}  // namespace raypick
