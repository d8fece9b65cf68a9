// closest_hit and occluded, wherever the plan put the geometry.
#if BVH
#import geometry/bvh4.wgsl
#else
#import geometry/unrolled.wgsl
#endif
