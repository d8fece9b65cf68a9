// The choice of a channel where channels are not scattered alike. src/reference/bsdf/channels.rs is the same in f64.
#import core/math.wgsl
#import shading/surface.wgsl

// Each channel's share of what the path carries.
fn carried_shares(surface: Surface) -> Spectrum {
#if CARRIED_LIGHT
    let sum = dot(surface.carried, WHITE);
    if sum > 0.0 {
        return surface.carried / sum;
    }
#endif
    return Spectrum(1.0 / 3.0);
}

struct ChosenChannel {
    // 3 where no channel has a share.
    channel: u32,
    // The rest of the random number, for further choices.
    left: f32,
}

// The channel that a number from 0 up to the sum of all shares chooses.
fn choose_channel(shares: Spectrum, u: f32) -> ChosenChannel {
    var below = 0.0;
    var start = 0.0;
    var chosen = 3u;
    for (var channel = 0u; channel < 3u; channel++) {
        // The last channel of any share takes what rounding leaves.
        if shares[channel] > 0.0 && (chosen == 3u || u >= below) {
            chosen = channel;
            start = below;
        }
        below += shares[channel];
    }
    return ChosenChannel(chosen, clamp((u - start) / shares[min(chosen, 2u)], 0.0, 0.99999994));
}
