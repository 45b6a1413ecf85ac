/* SPDX-License-Identifier: GPL-3.0-or-later
 * The signatures of MATLAB's C MEX API (documentation of R2019b, "C Matrix API" and "C MEX API") of the
 * functions that matlab-compat/mex calls: arrays are of a type of their own, which Octave's header, where
 * they are `void`, does not check. For the compiler's eyes only. */
#ifndef MEX_H
#define MEX_H
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
typedef struct mxArray_tag mxArray;
typedef size_t mwSize;
typedef size_t mwIndex;
typedef bool mxLogical;
typedef enum { mxREAL, mxCOMPLEX } mxComplexity;
typedef enum {
    mxUNKNOWN_CLASS, mxCELL_CLASS, mxSTRUCT_CLASS, mxLOGICAL_CLASS, mxCHAR_CLASS, mxVOID_CLASS,
    mxDOUBLE_CLASS, mxSINGLE_CLASS, mxINT8_CLASS, mxUINT8_CLASS, mxINT16_CLASS, mxUINT16_CLASS,
    mxINT32_CLASS, mxUINT32_CLASS, mxINT64_CLASS, mxUINT64_CLASS, mxFUNCTION_CLASS
} mxClassID;
void mexFunction (int nlhs, mxArray *plhs[], int nrhs, const mxArray *prhs[]);
int  mexAtExit (void (*function) (void));
void mexErrMsgIdAndTxt (const char *id, const char *format, ...);
bool mxIsDouble (const mxArray *a), mxIsComplex (const mxArray *a), mxIsSparse (const mxArray *a);
bool mxIsLogical (const mxArray *a), mxIsChar (const mxArray *a), mxIsCell (const mxArray *a);
bool mxIsEmpty (const mxArray *a), mxIsUint64 (const mxArray *a), mxIsUint8 (const mxArray *a);
size_t  mxGetM (const mxArray *a), mxGetN (const mxArray *a), mxGetNumberOfElements (const mxArray *a);
mwSize  mxGetNumberOfDimensions (const mxArray *a);
double  mxGetScalar (const mxArray *a);
double *mxGetPr (const mxArray *a);
void   *mxGetData (const mxArray *a);
mxLogical *mxGetLogicals (const mxArray *a);
mwIndex *mxGetIr (const mxArray *a), *mxGetJc (const mxArray *a);
int     mxGetString (const mxArray *a, char *text, mwSize size);
char   *mxArrayToString (const mxArray *a);
mxArray *mxGetCell (const mxArray *a, mwIndex i);
void    mxSetCell (mxArray *a, mwIndex i, mxArray *value);
int     mxAddField (mxArray *a, const char *name);
void    mxSetField (mxArray *a, mwIndex i, const char *name, mxArray *value);
mxArray *mxCreateDoubleMatrix (mwSize m, mwSize n, mxComplexity complexity);
mxArray *mxCreateDoubleScalar (double value);
mxArray *mxCreateLogicalMatrix (mwSize m, mwSize n);
mxArray *mxCreateLogicalScalar (bool value);
mxArray *mxCreateCellMatrix (mwSize m, mwSize n);
mxArray *mxCreateStructMatrix (mwSize m, mwSize n, int fields, const char **names);
mxArray *mxCreateString (const char *text);
mxArray *mxCreateSparse (mwSize m, mwSize n, mwSize nzmax, mxComplexity complexity);
mxArray *mxCreateNumericArray (mwSize n, const mwSize *size, mxClassID type, mxComplexity complexity);
void    mxDestroyArray (mxArray *a);
void   *mxCalloc (size_t n, size_t size);
void    mxFree (void *p);
#endif
