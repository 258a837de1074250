/* Faults in shaders: texts that are replaced when a shader is read. make_faults writes the table, whose last
 * item has no name. */
#ifndef TOILE_TESTS_APP_FAULTS_SHADER_FAULTS_H
#define TOILE_TESTS_APP_FAULTS_SHADER_FAULTS_H

struct shader_fault {
    const char *name, *file, *from, *to;
};
extern const struct shader_fault shader_faults[];

#endif
