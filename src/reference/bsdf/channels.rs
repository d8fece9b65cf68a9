//! The choice of a channel where channels are not scattered alike. `shaders/shading/material/channels.wgsl` is the same in f32.

/// The channel that a number from 0 up to the sum of all shares chooses, and the rest of the number for further choices, from 0 to 1. The last channel
/// of any share takes what rounding leaves. None where no channel has a share.
pub fn choose_channel(shares: [f64; 3], u: f64) -> Option<(usize, f64)> {
    let (mut chosen, mut start, mut below) = (None, 0.0, 0.0);
    for (channel, &share) in shares.iter().enumerate() {
        if share > 0.0 && (chosen.is_none() || u >= below) {
            (chosen, start) = (Some(channel), below);
        }
        below += share;
    }
    chosen.map(|channel| (channel, ((u - start) / shares[channel]).clamp(0.0, 1.0 - f64::EPSILON)))
}
