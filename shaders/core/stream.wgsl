// Random numbers in (0, 1), as many as are asked for, hashed from a key.
#import core/sampler.wgsl

struct Stream {
    key: u32,
    count: u32,
}

fn draw(stream: ptr<function, Stream>) -> f32 {
    (*stream).count++;
    return open_float(mix_bits((*stream).key + (*stream).count * GOLDEN));
}
