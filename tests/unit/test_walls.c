// Prescribed motion of walls against closed forms.
#include "dynamics/walls.h"
#include "harness.h"

static scree_wall_def make_def(void)
{
    scree_wall_def def = {0};
    def.position[0] = 1;
    def.orientation[0] = 1;
    def.motion.axis[2] = 2; // not a unit vector on purpose
    def.motion.end = INFINITY;
    def.removed_at = INFINITY;
    return def;
}

static void test_fixed_wall_never_moves(void)
{
    const scree_wall_def def = make_def();
    scree_wall_state state = {0};
    scree_wall_state_at(&def, 123.0, &state);
    SCREE_CHECK(state.pose.position.x == 1 && state.pose.position.y == 0 && state.pose.position.z == 0);
    SCREE_CHECK(state.velocity.x == 0 && state.angular_velocity.z == 0 && state.is_present);
}

static void test_translation_between_start_and_end(void)
{
    scree_wall_def def = make_def();
    def.motion.kind = SCREE_MOTION_TRANSLATE;
    def.motion.velocity[1] = 2;
    def.motion.start = 1;
    def.motion.end = 3;
    const double times[] = {0, 1, 1.5, 3, 10}, expected[] = {0, 0, 1, 4, 4}, velocity[] = {0, 2, 2, 0, 0};
    for (int k = 0; k < 5; ++k)
    {
        scree_wall_state state = {0};
        scree_wall_state_at(&def, times[k], &state);
        SCREE_CHECK_CLOSE(state.pose.position.y, expected[k], 0);
        SCREE_CHECK_CLOSE(state.velocity.y, velocity[k], 0);
    }
}

static void test_rotation_about_an_axis(void)
{
    scree_wall_def def = make_def();
    def.motion.kind = SCREE_MOTION_ROTATE;
    def.motion.angular_velocity = 3;
    for (int k = 0; k < 20; ++k)
    {
        const double time = 0.37 * k;
        scree_wall_state state = {0};
        scree_wall_state_at(&def, time, &state);
        const double eps = 16 * (double)SCREE_REAL_EPSILON;
        SCREE_CHECK_CLOSE(state.pose.position.x, cos(3 * time), eps);
        SCREE_CHECK_CLOSE(state.pose.position.y, sin(3 * time), eps);
        const scree_vec3 x = scree_mat3_apply(scree_mat3_from_quat(state.pose.orientation), scree_vec3_make(1, 0, 0));
        SCREE_CHECK_CLOSE(x.x, cos(3 * time), eps);
        SCREE_CHECK_CLOSE(x.y, sin(3 * time), eps);
        SCREE_CHECK_CLOSE(state.angular_velocity.z, 3, 0);
    }
}

static void test_removed_wall(void)
{
    scree_wall_def def = make_def();
    def.removed_at = 2;
    scree_wall_state state = {0};
    scree_wall_state_at(&def, 1.999, &state);
    SCREE_CHECK(state.is_present);
    scree_wall_state_at(&def, 2.0, &state);
    SCREE_CHECK(!state.is_present);
}

int main(void)
{
    SCREE_RUN(test_fixed_wall_never_moves);
    SCREE_RUN(test_translation_between_start_and_end);
    SCREE_RUN(test_rotation_about_an_axis);
    SCREE_RUN(test_removed_wall);
    return SCREE_TEST_END();
}
