// A surface's lobes with the stack that it may have. src/reference/layered/scatterer.rs is the same in f64, and says how they share directions.
#import core/layout.wgsl
#import core/math.wgsl
#import core/sampler.wgsl
#import shading/layered/stack.wgsl
#import shading/layered/approximation.wgsl
#if LAYERS_BY_WALK
#import shading/layered/walk.wgsl
#endif
#import shading/material/bsdf.wgsl
#import shading/material/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl

// Tells the numbers of walks that draw from those that choose a stack.
const DRAW_KEY: u32 = 0x5851f42du;

// The stack that was chosen of a surface's.
struct ChosenStack {
    stack: Stack,
    // Its weight in the blend, over the probability of its choice among stacks.
    weight: f32,
    // The probability with which it draws wi; 0: there is none.
    probability: f32,
    // Key of the numbers of walks that draw wi.
    key: u32,
}

// The stack of a surface with these lobes. `choice` picks the part of a blend where one is picked.
fn choose_stack(surface: Surface, bsdf: Bsdf, wo: vec3<f32>, choice: f32, key: u32) -> ChosenStack {
    var chosen: ChosenStack;
    chosen.key = key;
#if PICK
    let part = pick_part(surface, wo, choice);
    if is_stack(part.material) && (!part.front_only || surface.front) {
        chosen.stack = stack_at(part.material, surface);
        chosen.weight = 1.0;
        chosen.probability = 1.0;
    }
#else
    let seen = seen_along(surface, wo);
    let run = part_run(surface.material);
    // One of several stacks is chosen by its weight, and stands for all.
    var total = 0.0;
    var below = 0.0;
    var material = NONE;
    let u = uniform_float(mix_bits(key));
    for (var index = 0u; index < 2u * run.count; index++) {
        let adds_up = index < run.count;
        let part = weighted_part(run, select(index - run.count, index, adds_up), seen, surface.uv);
        if !is_stack(part.material) || (part.front_only && !surface.front) {
            continue;
        }
        if adds_up {
            total += part.weight;
        } else {
            if part.weight > 0.0 && (material == NONE || u * total >= below) {
                material = part.material;
            }
            below += part.weight;
        }
    }
    if material != NONE {
        chosen.stack = stack_at(material, surface);
        chosen.weight = total;
        chosen.probability = total / (total + sampling_weight_of(bsdf));
    }
#endif
    return chosen;
}

// The surface and its normal agree on which side a direction is.
fn leads_out(surface: Surface, wi: vec3<f32>) -> bool {
    return on_wo_side(surface, wi) || on_far_side(surface, wi);
}

// The value of the lobes and the stack towards one light more.
fn evaluate_layered(chosen: ChosenStack, lobes: BsdfValue, surface: Surface, wo: vec3<f32>, wi: vec3<f32>, key: u32) -> BsdfValue {
    var value = no_value();
    if leads_out(surface, wi) {
        let by_walk = HAS_LAYERS_BY_WALK && (chosen.stack.flags & LAYERS_STRAIGHT) == 0u;
        value = evaluate_straight(chosen.stack, surface, wo, wi, by_walk);
#if LAYERS_BY_WALK
        if by_walk {
            value.value = walk_through(chosen.stack, surface, wo, true, wi, key, false, vec3<f32>(0.0), 0u).towards_light;
        }
#endif
    }
    let pdf = (1.0 - chosen.probability) * lobes.pdf_solid_angle + chosen.probability * value.pdf_solid_angle;
    return BsdfValue(lobes.value + chosen.weight * value.value, pdf);
}

// The value towards a light, if one is sampled, and a drawn direction: `choice` chooses between the stack, if there is one, and the lobes. Surfaces with
// and without a stack share this code, and both directions are evaluated by the same, for drivers that copy a function to each of its calls.
fn scatter_layered(
    chosen: ChosenStack, bsdf: Bsdf, surface: Surface, wo: vec3<f32>, samples_light: bool, light_wi: vec3<f32>, light_key: u32, choice: f32,
    u: f32, v: f32
) -> Scattering {
    let stack = chosen.stack;
    let probability = chosen.probability;
    let has_lobes = probability < 1.0;
    let by_stack = choice < probability;
    let by_walk = HAS_LAYERS_BY_WALK && (stack.flags & LAYERS_STRAIGHT) == 0u;
    let estimates = probability > 0.0 && samples_light && leads_out(surface, light_wi);
    var light_value = BLACK;
    var drawn = no_sample();
    if probability > 0.0 {
        let own = vec3<f32>(min(choice / probability, LARGEST_NUMBER), u, v);
#if LAYERS_BY_WALK
        if by_walk {
            let ways = walk_through(stack, surface, wo, estimates, light_wi, light_key, by_stack, own, mix_bits(chosen.key ^ DRAW_KEY));
            light_value = ways.towards_light;
            drawn = ways.drawn;
        }
#endif
#if LAYERS_STRAIGHT_THROUGH
        if !by_walk && by_stack {
            drawn = draw_straight(stack, surface, wo, own.x, u, v);
        }
#endif
    }
    var evaluates_draw = by_stack && max_component(drawn.weight) > 0.0 && drawn.pdf_solid_angle >= 0.0;
#if MORE_LOBES
    var directed = Draw(no_sample(), false);
#endif
    if !by_stack {
        let left = clamp((choice - probability) / (1.0 - probability), 0.0, LARGEST_NUMBER);
#if MORE_LOBES
        directed = draw_direction(bsdf, surface, wo, left, u, v);
        drawn = directed.chosen;
        evaluates_draw = directed.mixed;
#else
        drawn = sample_bsdf(bsdf, surface, wo, left, u, v);
#endif
    }
    let leads = max_component(drawn.weight) > 0.0 && leads_out(surface, drawn.wi);
    // Values of the lobes, and of the stack.
    var light_lobes = no_value();
    var draw_lobes = no_value();
    var light_pdf = 0.0;
    var straight = no_value();
    for (var direction = 0u; direction < 2u; direction++) {
        let towards_light = direction == 0u;
        let wi = select(drawn.wi, light_wi, towards_light);
        if has_lobes && select(evaluates_draw, samples_light, towards_light) {
            let value = evaluate_bsdf(bsdf, surface, wo, wi);
            if towards_light {
                light_lobes = value;
            } else {
                draw_lobes = value;
            }
        }
        if probability > 0.0 && select(leads && drawn.pdf_solid_angle >= 0.0, estimates, towards_light) {
            let value = evaluate_straight(stack, surface, wo, wi, by_walk);
            if towards_light {
                light_pdf = value.pdf_solid_angle;
                if !by_walk {
                    light_value = value.value;
                }
            } else {
                straight = value;
            }
        }
    }
    let light_sum = BsdfValue(
        light_lobes.value + chosen.weight * light_value,
        (1.0 - probability) * light_lobes.pdf_solid_angle + probability * light_pdf
    );
    if !by_stack {
#if MORE_LOBES
        drawn = mixed_sample(directed, draw_lobes);
#endif
        if probability > 0.0 {
            drawn.weight /= 1.0 - probability;
            if drawn.pdf_solid_angle >= 0.0 {
                drawn.pdf_solid_angle = (1.0 - probability) * drawn.pdf_solid_angle + probability * straight.pdf_solid_angle;
            }
        }
        return shadowed(Scattering(light_sum, drawn), surface, light_wi);
    }
    if !leads || (!by_walk && drawn.pdf_solid_angle >= 0.0 && straight.pdf_solid_angle <= 0.0) {
        return shadowed(Scattering(light_sum, no_sample()), surface, light_wi);
    }
    if drawn.pdf_solid_angle >= 0.0 {
        if !by_walk {
            drawn.weight = straight.value / straight.pdf_solid_angle;
        }
        drawn.pdf_solid_angle = (1.0 - probability) * draw_lobes.pdf_solid_angle + probability * straight.pdf_solid_angle;
    }
    drawn.weight *= chosen.weight / probability;
    return shadowed(Scattering(light_sum, drawn), surface, light_wi);
}
