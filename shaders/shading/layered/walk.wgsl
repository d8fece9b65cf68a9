// Walks through a stack: an estimate of its value towards a light, and a direction that is drawn. src/reference/layered/evaluation.rs is the same in
// f64, and says why sequences of events are joined where they are. All walks share the same code, for drivers that copy a function to each of its calls.
#import core/layout.wgsl
#import core/math.wgsl
#import core/stream.wgsl
#import shading/layered/stack.wgsl
#import shading/layered/walker.wgsl
#import shading/material/bsdf.wgsl
#import shading/material/scattering.wgsl
#import shading/medium/medium.wgsl
#import shading/medium/phase.wgsl
#import shading/surface.wgsl

// A straight piece of the way from the light, at which the way from wo may be joined.
struct Piece {
    exists: bool,
    walker: Walker,
    // The interface that it leads to; NONE to the outside.
    ahead: u32,
}

fn piece_of(stack: Stack, walker: Walker) -> Piece {
    return Piece(true, walker, interface_ahead(stack, walker.gap, walker.direction));
}

// Some event on it may be wider than all events before it.
fn can_be_joined(piece: Piece, stack: Stack, slab: Slab) -> bool {
    var breadth = slab.breadth;
    if piece.ahead != NONE {
        breadth = max(breadth, layer_interface(stack, piece.ahead).breadth);
    }
    return breadth > piece.walker.breadth;
}

// About how much it brings where it is joined.
fn carried_by(piece: Piece, stack: Stack) -> f32 {
    return max_component(piece.walker.weight) * max(abs(dot(piece.walker.direction, stack.up)), SMALLEST_LAYER_COSINE);
}

// The share of light that is left after a part of the piece of this height.
fn left_over(piece: Piece, stack: Stack, slab: Slab, height: f32) -> Spectrum {
    if !HAS_SLABS || slab.flags == 0u {
        return WHITE;
    }
    return light_left(slab.extinction, height / max(abs(dot(piece.walker.direction, stack.up)), SMALLEST_LAYER_COSINE));
}

struct StackWays {
    // f |cos| towards the light, ways by single directions alone left out.
    towards_light: Spectrum,
    // A density of 0 stands for one that is not known.
    drawn: BsdfSample,
}

// The three walks, one after the other.
const FROM_LIGHT: u32 = 0u;
const ESTIMATE: u32 = 1u;
const DRAW: u32 = 2u;

// `light_key` and `draw_key` are those of random numbers, `first` the numbers of the drawn direction's first event.
fn walk_through(
    stack: Stack, surface: Surface, wo: vec3<f32>, estimates: bool, light_wi: vec3<f32>, light_key: u32, draws: bool, first: vec3<f32>,
    draw_key: u32
) -> StackWays {
    var found = StackWays(BLACK, no_sample());
    if !estimates && !draws {
        return found;
    }
    var walk = select(DRAW, FROM_LIGHT, estimates);
    var stream = Stream(select(draw_key, light_key, estimates), 0u);
    var walker = walker_into(stack, select(wo, light_wi, estimates));
    // The piece outside, and one of all others, chosen by what they carry.
    var outside: Piece;
    var chosen: Piece;
    var total = 0.0;
    if estimates {
        outside = piece_of(stack, walker);
    }
    var is_first = true;
    loop {
        var goes_on = true;
        var is_scattered = false;
        let slab = slab_in(stack, surface, walker.gap);
        let flown = walk != FROM_LIGHT || !is_first;
        if walk == FROM_LIGHT && walker.breadth >= stack.most_breadth {
            goes_on = false;
        } else if flown {
            if walk == FROM_LIGHT {
                let piece = piece_of(stack, walker);
                if can_be_joined(piece, stack, slab) {
                    let carried = carried_by(piece, stack);
                    total += carried;
                    if draw(&stream) * total < carried {
                        chosen = piece;
                    }
                }
            }
            is_scattered = flies(&walker, stack, slab, &stream);
        }
        if goes_on && is_scattered {
            if HAS_SLABS_SCATTER {
                if walk == ESTIMATE && chosen.exists && chosen.walker.gap == walker.gap
                    && chosen.walker.breadth < slab.breadth && walker.breadth <= slab.breadth {
                    let falls = dot(chosen.walker.direction, stack.up) < 0.0;
                    let height = select(chosen.walker.depth - walker.depth, walker.depth - chosen.walker.depth, falls);
                    if height >= 0.0 {
                        let value = evaluate_phase(slab.phase, -walker.direction, -chosen.walker.direction).value;
                        found.towards_light += walker.weight * value * chosen.walker.weight * left_over(chosen, stack, slab, height);
                    }
                }
                let cosine = abs(dot(walker.direction, stack.up));
                goes_on = scatter_in_slab(&walker, slab, &stream);
                if walk == FROM_LIGHT {
                    // Depths were drawn along the way before; the sum over ways has them along the way from wo.
                    walker.weight *= cosine / max(abs(dot(walker.direction, stack.up)), SMALLEST_LAYER_COSINE);
                }
            }
        } else if goes_on {
            let number = interface_ahead(stack, walker.gap, walker.direction);
            if number == NONE {
                if walk == DRAW {
                    let pdf_solid_angle = select(0.0, -1.0, walker.breadth == 0.0);
                    found.drawn = BsdfSample(walker.direction, walker.weight, pdf_solid_angle, walker.eta * walker.eta, false);
                }
                goes_on = false;
            } else {
                let blend_number = draw(&stream);
                var numbers: vec3<f32>;
                numbers.x = draw(&stream);
                numbers.y = draw(&stream);
                numbers.z = draw(&stream);
                if walk == DRAW && is_first {
                    numbers = first;
                }
                let arrives = -walker.direction;
                let breadth = layer_interface(stack, number).breadth;
                var drawn = no_sample();
#if MORE_LOBES
                var directed = Draw(no_sample(), false);
#endif
                var normal = stack.up;
                var turned = BLACK;
                // The interface draws a direction, and is evaluated towards both pieces, along the drawn direction, and as light sees it that comes
                // from there.
                for (var request = 0u; request < 5u; request++) {
                    var piece = outside;
                    if request == 2u {
                        piece = chosen;
                    }
                    var wanted = walk == ESTIMATE && piece.exists && piece.ahead == number && piece.walker.breadth < breadth && walker.breadth <= breadth;
                    var view_wo = arrives;
                    var wi = -piece.walker.direction;
                    if request == 0u {
                        wanted = true;
                    }
                    if request == 3u {
                        wanted = false;
                        wi = drawn.wi;
#if MORE_LOBES
                        wanted = directed.mixed;
#endif
                    }
                    if request == 4u {
                        wanted = walk == FROM_LIGHT && drawn.pdf_solid_angle > 0.0 && max_component(drawn.weight) > 0.0;
                        view_wo = drawn.wi;
                        wi = arrives;
                    }
                    if !wanted {
                        continue;
                    }
                    let seen = interface_surface(stack, surface, number, view_wo, walker.weight);
                    let bsdf = load_bsdf(seen, view_wo, blend_number);
                    if request == 0u {
                        normal = seen.shading_normal;
#if MORE_LOBES
                        directed = draw_direction(bsdf, seen, arrives, numbers.x, numbers.y, numbers.z);
                        drawn = directed.chosen;
#else
                        drawn = sample_bsdf(bsdf, seen, arrives, numbers.x, numbers.y, numbers.z);
#endif
                        continue;
                    }
                    let value = evaluate_bsdf(bsdf, seen, view_wo, wi);
                    if request < 3u {
                        let behind = slab_in(stack, surface, piece.walker.gap);
                        let left = left_over(piece, stack, behind, height_ahead(piece.walker, stack, behind));
                        found.towards_light += walker.weight * value.value * piece.walker.weight * left;
                    }
#if MORE_LOBES
                    if request == 3u {
                        drawn = mixed_sample(directed, value);
                    }
#endif
                    if request == 4u {
                        turned = value.value / drawn.pdf_solid_angle;
                    }
                }
                if max_component(drawn.weight) <= 0.0 {
                    goes_on = false;
                } else {
                    if walk == FROM_LIGHT {
                        if drawn.is_null {
                            turned = drawn.weight;
                        } else if drawn.pdf_solid_angle < 0.0 {
                            // Smooth surfaces are reciprocal but for the squared ratio of indices of refraction by which radiance scales.
                            let cosines = abs(dot(arrives, normal)) / max(abs(dot(drawn.wi, normal)), SMALLEST_LAYER_COSINE);
                            turned = drawn.weight * (cosines * drawn.eta_scale);
                        }
                        walker.weight *= turned;
                    } else {
                        walker.weight *= drawn.weight;
                        walker.eta *= sqrt(drawn.eta_scale);
                    }
                    goes_on = leave_interface(&walker, stack, surface, number, drawn, &stream);
                }
            }
        }
        is_first = false;
        if goes_on {
            continue;
        }
        if walk == DRAW || (walk == ESTIMATE && !draws) {
            break;
        }
        if walk == FROM_LIGHT {
            walk = ESTIMATE;
            if chosen.exists {
                chosen.walker.weight *= total / carried_by(chosen, stack);
            }
        } else {
            walk = DRAW;
            stream = Stream(draw_key, 0u);
        }
        walker = walker_into(stack, wo);
        is_first = true;
    }
    return found;
}
